#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

/// A node of a rod, counted from the rod's first one.
struct JointNode {
  std::uint32_t rod = 0;
  std::uint32_t node = 0;
};

struct JointParts;
class Damping;

/// Joints of rods with each other or with themselves: nodes that are one place.
///
/// The nodes of a place have the same positions, to the last bit: the solver searches the minimum
/// among such positions only, so that a joint has no stiffness of its own and gives way to no load.
/// The force in it is that with which the constraint acts, the Lagrange multiplier of the place.
///
/// A weld also keeps the angles between the edges that meet there as they are when it is added.
/// Each edge ends there in half its length of rod, which resists bending and, with the effect
/// Twist, twist. These springs with stiffnesses kᵢ lead to one point, and between two edges that is
/// a spring of kᵢ kⱼ / Σ k: of two like edges it is that of a node inside of a rod. Without Twist
/// edges turn freely about themselves, and what meets them turns with them: of two edges, only the
/// angle between them stays.
///
/// A closed rod is one whose last node is its first one again. It bends and twists there as at any
/// node inside, natural curvature included.
class Joints {
 public:
  enum class Kind {
    BALL,  ///< edges turn freely about the place
    WELD   ///< edges keep their angles
  };

  /// Nodes that are one place.
  struct Joint {
    Kind kind = Kind::BALL;
    std::vector<JointNode> nodes;  ///< at least two
  };

  /// How welds and closed rods resist what is bent or twisted there.
  struct Options {
    bool has_bend = true;                    ///< as with the effect Bend
    std::shared_ptr<const Damping> damping;  ///< the effect, null without
  };

  explicit Joints(Options options);
  ~Joints();
  Joints(const Joints&) = delete;
  Joints& operator=(const Joints&) = delete;

  /// Nodes of a joint that are further apart than this part of the shortest edge there do not meet.
  static constexpr double max_gap = 1e-3;

  /// Joins nodes, and moves them to their common place.
  /// @param rods with their frames already, if there is to be twist
  /// @returns the index of the joint
  /// @throws std::invalid_argument naming joint, rod, node and value, for less than two nodes, rods
  ///         or nodes that there are not, nodes that do not meet, a node that is in a joint
  ///         already, or a weld without resistance to bending
  std::uint32_t add(Rods& rods, const Joint& joint);

  /// Closes a rod, whose last node must be where its first one is.
  /// @throws std::invalid_argument naming the rod, for one with less than three edges, ends that do
  ///         not meet, or a rod that is closed or joined already
  void close(Rods& rods, std::uint32_t rod);

  const std::vector<Joint>& joints() const { return joints_; }

  /// Makes the nodes of each place have the same position and velocity, those of their centre of
  /// mass, where they differ: rods may have been changed from outside.
  void unite(Rods& rods) const;

  /// Called as the functions of Effect of these names.
  void begin_step(const Rods& rods, const TimeStep& step);
  void end_step(const Rods& rods);

  /// Takes what other joints have come to in their steps, which were made alike for the same rods.
  void take_state(const Joints& other);

  /// Stored energy of welds and closed rods where the rods are [J].
  double stored_energy(const Rods& rods) const;

  /// The places and the welds, for the solver.
  const JointParts& parts() const { return *parts_; }

 private:
  Options options_;
  std::vector<Joint> joints_;
  std::unique_ptr<JointParts> parts_;
};

/// Rods as fibres, closed and joined as they are.
FiberAssembly assembly_of(const Rods& rods);

}  // namespace fiber

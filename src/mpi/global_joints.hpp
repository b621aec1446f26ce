#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fiber_proximity/geometry/fiber_topology.hpp"
#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "src/mpi/communicator.hpp"

namespace fiber {

/// A point of a fibre that has the number of a joint.
struct GlobalJointPoint {
  std::uint64_t fiber = 0;
  std::uint64_t point = 0;  ///< its index along the fibre
  std::int32_t joint = -1;
};

/// The joints among the fibres of all ranks, the same on every rank. Closed fibres are no joints
/// here: which fibre is closed is known to the ranks that have a part of it.
class GlobalJoints {
 public:
  /// Points begin … end - 1, for range-based for.
  struct Points {
    const GlobalJointPoint* first;
    const GlobalJointPoint* last;
    const GlobalJointPoint* begin() const { return first; }
    const GlobalJointPoint* end() const { return last; }
  };

  GlobalJoints() = default;

  /// Finds the joints of parts that make whole fibres. Collective.
  /// @param topology see part_topology()
  /// @throws std::invalid_argument on every rank naming the fibre where two parts of it do not
  ///         agree about a point or whether it is closed, and where a closed fibre is too short;
  ///         where ranks give another joint_tolerance
  GlobalJoints(const Communicator& ranks, const FiberAssembly& parts,
               const std::vector<FiberPart>& names, const FiberTopology& topology);

  /// Whether no fibre of any rank is closed or joined.
  bool empty() const { return is_empty_; }

  /// The points of a fibre that are joined with others, by point. The last point of a closed fibre,
  /// which is its first one, is not among them.
  Points points_of(std::uint64_t fiber) const;

  /// The smallest of the fibres that are joined with this one; none if it has no joint.
  std::optional<std::uint64_t> component_of(std::uint64_t fiber) const;

  /// A number that no joint has, the smallest that is larger than `last`.
  std::int32_t next_free_number(std::int32_t last) const;

  /// The smallest number that one point alone has, so that it joins nothing.
  const std::optional<std::int32_t>& lonely() const { return lonely_; }

  const std::optional<double>& tolerance() const { return tolerance_; }  ///< [m]

 private:
  struct FiberComponent {
    std::uint64_t fiber = 0;
    std::uint64_t component = 0;
  };

  void take(std::vector<GlobalJointPoint> numbered);

  bool is_empty_ = true;
  std::vector<GlobalJointPoint> points_;    // by fibre and point
  std::vector<std::int32_t> numbers_;       // of joints, sorted
  std::vector<FiberComponent> components_;  // by fibre
  std::optional<std::int32_t> lonely_;
  std::optional<double> tolerance_;  // [m]
};

/// The smallest number of a joint that one point of all ranks alone has. Collective.
/// @throws std::invalid_argument as part_topology() and GlobalJoints
std::optional<std::int32_t> find_lonely_joint(const Communicator& ranks,
                                              const DistributedFibers& fibers);

}  // namespace fiber

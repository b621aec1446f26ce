#pragma once

#include <memory>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/sim/contact_source.hpp"

namespace fiber {

/// Contacts of rods with themselves, with each other, or both: as springs between the axes where
/// they are nearest, whose force begins where the surfaces meet.
///
/// Candidates come from run_tree, with a reach that serves as long as nothing moves further. Two
/// edges cannot pass through each other: where they are nearest when a step begins, a plane across
/// the line between them parts them, which moves with them but does not turn in the step.
class FiberContact : public ContactSource {
 public:
  struct Options {
    Pairing pairing = Pairing::ALL;

    /// [N/m] >= 0; 0 derives it from the rods: a fifth of Young's modulus times the radius, about
    /// what crossed cylinders have when they are pressed together by a twentieth of it, but at most
    /// what moves a node by its whole depth in a thirtieth of a step.
    double stiffness = 0.0;
  };

  /// @throws std::invalid_argument for a stiffness that is negative or not finite
  explicit FiberContact(const Options& options);

  void begin_step(const Rods& rods, const TimeStep& step) override;
  void measure(const Rods& rods) override;
  void find(const Rods& rods, std::vector<ContactPoint>& points) const override;
  void limit(const Rods& rods, std::vector<Eigen::Vector3d>& displacements, Way way,
             int round) override;
  void join(const Rods& rods, const std::vector<Eigen::Vector3d>& displacements,
            Islands& islands) override;

 private:
  struct Candidate {
    std::uint32_t rod_a;
    std::uint32_t edge_a;
    std::uint32_t rod_b;
    std::uint32_t edge_b;
  };

  /// Edges do not pass through each other as long as all of b is further along the normal than all
  /// of a, wherever both go.
  struct Parting {
    Eigen::Vector3d normal;  // 0 for edges that may
    double room;             // to leave between a and b [m]
  };

  void find_candidates(const Rods& rods);
  void part_candidates(const Rods& rods);
  void measure_at(const std::vector<Eigen::Vector3d>& positions);
  bool keep_apart(const Rods& rods, std::size_t candidate, bool is_fixed,
                  std::vector<Eigen::Vector3d>& displacements) const;
  bool is_known(const Rods& rods, const std::vector<Eigen::Vector3d>& displacements, Way way);
  bool look_further(const Rods& rods, const std::vector<Eigen::Vector3d>& displacements, Way way);
  void limit_to_known(const Rods& rods, std::vector<Eigen::Vector3d>& displacements, Way way);
  double needed_reach(const Rods& rods, const std::vector<Eigen::Vector3d>& displacements,
                      Way way) const;
  bool limit_to_sides(const Rods& rods, std::vector<Eigen::Vector3d>& displacements,
                      bool is_settling) const;
  double stiffness_of(const Rods& rods, const Candidate& candidate) const;

  Options options_;
  std::unique_ptr<ProximityEngine> engine_;
  std::vector<Eigen::Vector3d> beginning_;      // of the step: where nodes were [m]
  std::vector<Eigen::Vector3d> displacements_;  // that its velocities would bring [m]
  std::vector<double> material_stiffness_;      // of contacts, by rod [N/m]
  FiberAssembly fibers_;  // where the rods were when candidates were looked for
  QueryResult result_;
  std::vector<Candidate> candidates_;
  std::vector<Parting> partings_;                    // of the candidates
  std::vector<SegmentDistance> distances_;           // of the candidates, from a to b
  Eigen::Vector3d drift_ = Eigen::Vector3d::Zero();  // of all since candidates were looked for [m]
  double reach_ = 0.0;         // [m] surfaces further apart then are no candidates
  double longest_move_ = 0.0;  // [m] in this step
  double step_ = 0.0;          // [s]
};

}  // namespace fiber

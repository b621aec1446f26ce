#pragma once

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "fiber_proximity/sim/effect.hpp"

namespace fiber::test {

/// The way that rods go in a step of implicit Euler on one thread. It is not straight: each of
/// Newton's steps is, which is what the solver keeps free of contact. An effect that does nothing
/// looks on: derivatives are asked for where rods have come to, energies also where they try to go.
class SolverPath {
 public:
  /// Returns an effect to be added to a scene; this must outlive it.
  std::unique_ptr<Effect> watcher() { return std::make_unique<Watcher>(*this); }

  /// Where the last step began [m].
  const std::vector<Eigen::Vector3d>& start() const { return start_; }

  /// How many straight pieces the way of two rods beside each other has: more than one only if they
  /// have been moved together. Others keep to rooms of their own, whichever goes first.
  std::size_t pieces(std::uint32_t rod_a, std::uint32_t rod_b) const {
    const std::vector<Visit>& a = visits_[rod_a];
    const std::vector<Visit>& b = visits_[rod_b];
    const bool are_together = !a.empty() && !b.empty() && a.size() == b.size() &&
                              a.front().call <= b.back().call && b.front().call <= a.back().call;
    return are_together ? a.size() : 1;
  }

  /// Where a node is after so many of these pieces.
  /// @param node as Rods counts them
  const Eigen::Vector3d& position(std::uint32_t rod, std::uint32_t node, std::size_t piece,
                                  std::size_t pieces) const {
    const std::vector<Visit>& visits = visits_[rod];
    if (piece == 0 || visits.empty()) {
      return start_[node];
    }
    const Visit& visit = pieces == 1 ? visits.back() : visits[piece - 1];
    return visit.positions[node - offsets_[rod]];
  }

 private:
  struct Visit {
    std::size_t call;  // counted through
    std::vector<Eigen::Vector3d> positions;
  };

  class Watcher : public Effect {
   public:
    explicit Watcher(SolverPath& path) : path_(path) {}

    void begin_step(Rods& rods, const TimeStep& /*step*/) override {
      path_.start_ = rods.positions;
      path_.offsets_ = rods.offsets;
      path_.visits_.assign(rods.count(), {});
    }

    /// A solve may begin again with more room.
    void energy(const RodPack& rods, const std::vector<SimdBatch>& /*values*/,
                SimdBatch& energy) const override {
      energy = SimdBatch{};
      for (std::size_t lane = 0; lane < rods.used; ++lane) {
        const std::vector<Eigen::Vector3d> positions = positions_of(rods, lane);
        if (std::equal(positions.begin(), positions.end(),
                       path_.start_.begin() + rods.first_nodes[lane])) {
          path_.visits_[rods.rods[lane]].clear();
        }
      }
    }

    void add_derivatives(const RodPack& rods, const std::vector<SimdBatch>& /*values*/,
                         PackSystem& /*system*/) const override {
      ++path_.calls_;
      for (std::size_t lane = 0; lane < rods.used; ++lane) {
        path_.visits_[rods.rods[lane]].push_back({path_.calls_, positions_of(rods, lane)});
      }
    }

   private:
    static std::vector<Eigen::Vector3d> positions_of(const RodPack& rods, std::size_t lane) {
      std::vector<Eigen::Vector3d> positions;
      for (std::size_t node = 0; node < rods.node_count; ++node) {
        const SimdBatch* const x = &rods.positions[node * rods.unknowns];
        positions.emplace_back(x[0][lane], x[1][lane], x[2][lane]);
      }
      return positions;
    }

    SolverPath& path_;
  };

  std::vector<Eigen::Vector3d> start_;
  std::vector<std::uint32_t> offsets_;
  std::vector<std::vector<Visit>> visits_;  // by rod
  std::size_t calls_ = 0;
};

}  // namespace fiber::test

#pragma once

#include <memory>
#include <vector>

#include "fiber_proximity/geometry/simplified_fibers.hpp"
#include "fiber_proximity/query/engine.hpp"

namespace fiber {

/// Any engine over simplified fibres. It finds pairs of pieces, which enclose their runs of
/// segments, so no contact is missed; a contact of pieces stands for all pairs of their runs, see
/// EngineOptions::simplification. Where the neighbour skips tell segments of two runs apart, these
/// are no pair of pieces, but looked for one by one (UnsimplifiedPairs), and reported exactly.
class SimplifiedEngine final : public ProximityEngine {
 public:
  /// @param engine for the pieces
  /// @param deviation [m] of pieces from the fibres
  /// @throws std::invalid_argument for a deviation that is negative or not finite
  SimplifiedEngine(std::unique_ptr<ProximityEngine> engine, double deviation);

  std::uint32_t level_count() const override { return engine_->level_count(); }
  double mean_level_volume(std::uint32_t level) const override {
    return engine_->mean_level_volume(level);
  }
  std::uint64_t recomputed_count() const override { return engine_->recomputed_count(); }
  std::uint32_t thread_count() const override { return engine_->thread_count(); }
  std::size_t memory_bytes() const override;
  void level_boxes(std::uint32_t level, std::vector<NodeBox>& boxes) const override {
    engine_->level_boxes(level, boxes);
  }

  /// The pieces.
  const SimplifiedFibers& simplified() const { return simplified_; }

 protected:
  void do_update(const FiberAssembly& fibers, bool same_topology) override;
  void do_query(const FiberAssembly& fibers, const QueryOptions& options,
                QueryResult& result) const override;
  void do_query_shape(const FiberAssembly& shape, const FiberAssembly& fibers,
                      const QueryOptions& options, QueryResult& result) const override;

  // Motions are those of the fibres as they are.
  void do_update_motion(const FiberAssembly& before, const FiberAssembly& after,
                        bool same_topology) override;
  void do_query_motion(const MotionOptions& options, MotionResult& result) const override;
  void do_query_motion_shape(const FiberAssembly& shape_before, const FiberAssembly& shape_after,
                             const MotionOptions& options, MotionResult& result) const override;

 private:
  double restore(const FiberAssembly& fibers, std::uint32_t fiber, std::uint32_t& segment,
                 double& s, Contact& contact) const;
  void restore_a(const FiberAssembly& fibers, Contact& contact) const;
  void restore_b(const FiberAssembly& fibers, Contact& contact) const;

  const std::unique_ptr<ProximityEngine> engine_;
  const double deviation_;  // [m]
  SimplifiedFibers simplified_;
  double size_ = 0.0;  // [m] see size_of_segments()
};

}  // namespace fiber

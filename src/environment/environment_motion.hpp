#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/query/options.hpp"
#include "src/environment/allowed_parts.hpp"
#include "src/environment/world_shape.hpp"
#include "src/query/motion_evaluator.hpp"

namespace fiber {

/// Consecutive segments of one fibre, and what they sweep.
struct SweptRun {
  SweptRun(const FiberMotion& motion, std::uint32_t owner, std::uint32_t first_point,
           std::uint32_t last_point);

  std::uint32_t fiber;
  std::uint32_t begin;  // first points of the segments
  std::uint32_t end;
  WorldBox box;         // around the ways of their axes [m]
  double radius = 0.0;  // the largest of both states [m]
};

/// One query of an environment about a motion: first the pairs of segments and shapes that may
/// meet, then when these do.
class EnvironmentMotion {
 public:
  /// Holds references: they must outlive it.
  /// @param shapes by object, as WorldShape counts them
  EnvironmentMotion(const FiberMotion& motion, const std::vector<WorldShape>& shapes,
                    const std::vector<EnvironmentObject>& objects, const MotionOptions& options,
                    const AllowedPairs& allowed);

  /// Considers the pairs of a run and a shape.
  /// @return [m] shapes further than this from the run's box do not matter; minus infinity when no
  ///         more are looked for
  double offer(const SweptRun& run, const WorldShape& shape);

  /// Whether the deadline has passed, or there are too many pairs.
  bool done();

  /// When the pairs meet, on several threads; the same for any number of them.
  void evaluate(MotionResult& result);

 private:
  double within(double radius) const;
  void evaluate(const std::uint64_t* keys, std::size_t count, MotionSlice& slice) const;
  void evaluate(std::uint64_t key, MotionSlice& slice) const;

  const FiberMotion& motion_;
  const std::vector<WorldShape>& shapes_;
  const MotionOptions& options_;
  const AllowedParts allowed_;
  const QueryLimits limits_;
  MotionCandidates candidates_;  // a segment's first point and the index of a shape
};

}  // namespace fiber

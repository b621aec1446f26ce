#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/environment/allowed_pairs.hpp"
#include "fiber_proximity/environment/axis_distance.hpp"
#include "fiber_proximity/environment/shape_box.hpp"
#include "fiber_proximity/environment/shapes.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/pair_collector.hpp"
#include "src/environment/allowed_parts.hpp"

namespace fiber {

struct WorldShape;

/// Consecutive segments of one fibre.
struct SegmentRun {
  SegmentRun(const FiberAssembly& fibers, std::uint32_t owner, std::uint32_t first_point,
             std::uint32_t last_point);

  std::uint32_t fiber;
  std::uint32_t begin;  // first points of the segments
  std::uint32_t end;
  WorldBox box;         // around their axes [m]
  double radius = 0.0;  // the largest [m]
};

/// What is reported of a segment (a) and a shape (b); which segment it is is left open.
Contact contact_of(const Capsule& capsule, const WorldShape& shape, const AxisDistance& axis);

/// One query of an environment: decides which pairs of segments and shapes are contacts.
class EnvironmentQuery {
 public:
  /// Holds references: they must outlive it.
  EnvironmentQuery(const FiberAssembly& fibers, const std::vector<EnvironmentObject>& objects,
                   const QueryOptions& options, const AllowedPairs& allowed, QueryResult& result);

  /// Considers the pairs of a run and a shape.
  /// @return [m] shapes further than this from the axes of the run do not matter from now on; minus
  ///         infinity when the query is done
  double offer(const SegmentRun& run, const WorldShape& shape);

  bool done() { return accumulator_.done(); }
  void finish();

 private:
  double reach_of(const SegmentRun& run) const { return accumulator_.bound() + run.radius; }
  void offer_segment(const SegmentRun& run, std::uint32_t point, const WorldShape& shape);

  ContactAccumulator accumulator_;
  const FiberAssembly& fibers_;
  AllowedParts allowed_;
  QueryCounts& counts_;
};

}  // namespace fiber

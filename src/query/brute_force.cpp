#include "src/query/brute_force.hpp"

#include "fiber_proximity/query/for_engines/pair_collector.hpp"
#include "src/hierarchy/fiber_order.hpp"

namespace fiber {

void BruteForceEngine::do_update(const FiberAssembly& /*fibers*/, bool /*same_topology*/) {}

void BruteForceEngine::do_query(const FiberAssembly& fibers, const QueryOptions& options,
                                QueryResult& result) const {
  PairCollector collector(fibers, options, result);
  const std::vector<std::uint32_t> segments = end_point_connected_order(fibers.offsets());
  for (std::size_t i = 0; i < segments.size() && !collector.done(); ++i) {
    for (std::size_t j = i + 1; j < segments.size() && !collector.done(); ++j) {
      collector.offer(segments[i], segments[j]);
    }
  }
  collector.finish();
}

void BruteForceEngine::do_query_shape(const FiberAssembly& shape, const FiberAssembly& fibers,
                                      const QueryOptions& options, QueryResult& result) const {
  PairCollector collector(shape, fibers, options, result);
  const std::vector<std::uint32_t> shape_segments = end_point_connected_order(shape.offsets());
  const std::vector<std::uint32_t> segments = end_point_connected_order(fibers.offsets());
  for (std::size_t i = 0; i < shape_segments.size() && !collector.done(); ++i) {
    for (std::size_t j = 0; j < segments.size() && !collector.done(); ++j) {
      collector.offer(shape_segments[i], segments[j]);
    }
  }
  collector.finish();
}

}  // namespace fiber

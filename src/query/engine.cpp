#include "fiber_proximity/query/engine.hpp"

#include <stdexcept>

namespace fiber {
namespace {

// Contacts are left to those that write them: clearing them would have them all initialized anew.
void reset(QueryResult& result) {
  result.limit_reached = false;
  result.complete = true;
  result.counts = {};
}

const FiberAssembly& require_fibers(const FiberAssembly* fibers) {
  if (fibers == nullptr) {
    throw std::logic_error("the engine has no fibres yet: call update() first");
  }
  return *fibers;
}

}  // namespace

void ProximityEngine::update(const FiberAssembly& fibers) {
  const bool same_topology = fibers_ != nullptr && offsets_ == fibers.offsets();
  fibers_ = nullptr;  // an update that throws leaves no half-updated engine behind
  do_update(fibers, same_topology);
  if (!same_topology) {
    offsets_ = fibers.offsets();
  }
  fibers_ = &fibers;
}

void ProximityEngine::query(const QueryOptions& options, QueryResult& result) const {
  validate(options);
  reset(result);
  do_query(require_fibers(fibers_), options, result);
}

void ProximityEngine::query_shape(const FiberAssembly& shape, const QueryOptions& options,
                                  QueryResult& result) const {
  validate(options);
  reset(result);
  do_query_shape(shape, require_fibers(fibers_), options, result);
}

void ProximityEngine::level_boxes(std::uint32_t /*level*/, std::vector<NodeBox>& boxes) const {
  boxes.clear();
}

}  // namespace fiber

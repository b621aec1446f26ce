#include "fiber_proximity/query/engine.hpp"

#include <stdexcept>
#include <utility>

#include "fiber_proximity/bounds/aabb.hpp"
#include "fiber_proximity/query/brute_force.hpp"
#include "fiber_proximity/query/hierarchy_engine.hpp"

namespace fiber {
namespace {

template <class Engine>
std::unique_ptr<ProximityEngine> make() {
  return std::make_unique<Engine>();
}

using Factory = std::unique_ptr<ProximityEngine> (*)();

const std::vector<std::pair<std::string, Factory>>& factories() {
  static const std::vector<std::pair<std::string, Factory>> all{
      {"AL", make<HierarchyEngine<Aabb>>},
      {"brute_force", make<BruteForceEngine>},
  };
  return all;
}

void reset(QueryResult& result) {
  result.contacts.clear();
  result.limit_reached = false;
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

std::unique_ptr<ProximityEngine> make_engine(const std::string& name) {
  std::string known;
  for (const auto& [engine_name, factory] : factories()) {
    if (name == engine_name) {
      return factory();
    }
    known += (known.empty() ? "" : ", ") + engine_name;
  }
  throw std::invalid_argument("unknown engine '" + name + "', known are: " + known);
}

std::vector<std::string> engine_names() {
  std::vector<std::string> names;
  for (const auto& entry : factories()) {
    names.push_back(entry.first);
  }
  return names;
}

}  // namespace fiber

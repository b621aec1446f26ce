#pragma once

#include "src/query/brute_force.hpp"

namespace fiber::test {

/// Of an engine that is updated.
inline QueryResult answer(const ProximityEngine& engine, const QueryOptions& options = {}) {
  QueryResult result;
  engine.query(options, result);
  return result;
}
inline QueryResult answer(const ProximityEngine& engine, const FiberAssembly& shape,
                          const QueryOptions& options) {
  QueryResult result;
  engine.query_shape(shape, options, result);
  return result;
}

/// Of an engine of this name.
inline QueryResult answer(const std::string& name, const FiberAssembly& fibers,
                          const QueryOptions& options = {}) {
  const std::unique_ptr<ProximityEngine> engine = make_engine(name);
  engine->update(fibers);
  return answer(*engine, options);
}

/// Every pair tested: the oracle that all engines are held against.
inline QueryResult brute_force(const FiberAssembly& fibers, const QueryOptions& options = {}) {
  return answer("brute_force", fibers, options);
}
inline QueryResult brute_force(const FiberAssembly& shape, const FiberAssembly& fibers,
                               const QueryOptions& options) {
  BruteForceEngine engine;
  engine.update(fibers);
  return answer(engine, shape, options);
}

}  // namespace fiber::test

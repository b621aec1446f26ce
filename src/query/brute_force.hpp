#pragma once

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/query/engine.hpp"

namespace fiber {

/// Tests every pair, by the name `brute_force`: the oracle all other engines are held against.
/// O(n²).
class FIBER_PROXIMITY_EXPORT BruteForceEngine final : public ProximityEngine {
 protected:
  void do_update(const FiberAssembly& fibers, bool same_topology) override;
  void do_query(const FiberAssembly& fibers, const QueryOptions& options,
                QueryResult& result) const override;
  void do_query_shape(const FiberAssembly& shape, const FiberAssembly& fibers,
                      const QueryOptions& options, QueryResult& result) const override;
};

}  // namespace fiber

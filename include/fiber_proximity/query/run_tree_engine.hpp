#pragma once

#include <tbb/task_arena.h>

#include <memory>
#include <mutex>
#include <vector>

#include "fiber_proximity/hierarchy/run_tree.hpp"
#include "fiber_proximity/query/contact_batch.hpp"
#include "fiber_proximity/query/engine.hpp"

namespace fiber {

/// `run_tree`, the fast engine.
class RunTreeEngine final : public ProximityEngine {
 public:
  /// @param threads most to use, 0 for as many as there are cores
  explicit RunTreeEngine(std::uint32_t threads);

  std::uint32_t thread_count() const override;
  std::uint32_t level_count() const override;
  void level_boxes(std::uint32_t level, std::vector<NodeBox>& boxes) const override;
  double mean_level_volume(std::uint32_t level) const override;
  std::size_t memory_bytes() const override { return tree_.memory_bytes(); }

 protected:
  void do_update(const FiberAssembly& fibers, bool same_topology) override;
  void do_query(const FiberAssembly& fibers, const QueryOptions& options,
                QueryResult& result) const override;
  void do_query_shape(const FiberAssembly& shape, const FiberAssembly& fibers,
                      const QueryOptions& options, QueryResult& result) const override;

 private:
  /// All contacts, in memory that queries which run at the same time do not share.
  void find_all(const RunTreeView& a, const PairTest& test, double bound,
                QueryResult& result) const;

  mutable tbb::task_arena arena_;
  RunTree tree_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<ContactBatch>> idle_batches_;
};

}  // namespace fiber

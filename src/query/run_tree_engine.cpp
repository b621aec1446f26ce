#include "fiber_proximity/query/run_tree_engine.hpp"

#include <algorithm>

#include "fiber_proximity/hierarchy/origin.hpp"
#include "fiber_proximity/hierarchy/run_tree_kernels.hpp"
#include "fiber_proximity/query/pair_collector.hpp"

namespace fiber {
namespace {

/// Hands candidates to a collector one by one: for the queries whose bound shrinks.
class CollectorSink final : public PairSink {
 public:
  explicit CollectorSink(PairCollector& collector) : collector_(collector) {}

  bool offer(PointPair pair) override {
    collector_.offer(pair.a, pair.b);
    return !collector_.done();
  }

  float bound() const override { return collector_.bound(); }
  bool wants_adjacent() const override { return collector_.wants_adjacent(); }

 private:
  PairCollector& collector_;
};

void find_some(const RunTreeView& a, const RunTreeView& b, PairCollector& collector,
               QueryCounts& counts) {
  CollectorSink sink(collector);
  if (b.group_count() != 0) {
    find_near_segments(a, 0, a.group_count(), b, sink, counts);
  }
  collector.finish();
}

Eigen::Vector3d corner(const float (&by_axis)[3][run_width], std::uint32_t lane) {
  return {by_axis[0][lane], by_axis[1][lane], by_axis[2][lane]};
}

}  // namespace

RunTreeEngine::RunTreeEngine(std::uint32_t threads)
    : arena_(threads == 0 ? tbb::task_arena::automatic : static_cast<int>(threads)) {}

std::uint32_t RunTreeEngine::thread_count() const {
  return static_cast<std::uint32_t>(arena_.max_concurrency());
}

void RunTreeEngine::do_update(const FiberAssembly& fibers, bool same_topology) {
  const Eigen::Vector3d origin = hierarchy_origin(fibers);
  arena_.execute([&] {
    if (same_topology) {
      tree_.update(fibers, origin);
    } else {
      tree_.build(fibers, origin);
    }
  });
}

void RunTreeEngine::do_query(const FiberAssembly& fibers, const QueryOptions& options,
                             QueryResult& result) const {
  if (options.type == QueryType::ALL) {
    find_all(tree_.view(), PairTest(fibers, options), options.margin, result);
    return;
  }
  PairCollector collector(fibers, options, result);
  find_some(tree_.view(), tree_.view(), collector, result.counts);
}

void RunTreeEngine::do_query_shape(const FiberAssembly& shape, const FiberAssembly& fibers,
                                   const QueryOptions& options, QueryResult& result) const {
  RunTree shape_tree;
  shape_tree.build(shape, tree_.origin());
  if (options.type == QueryType::ALL) {
    find_all(shape_tree.view(), PairTest(shape, fibers, options), options.margin, result);
    return;
  }
  PairCollector collector(shape, fibers, options, result);
  find_some(shape_tree.view(), tree_.view(), collector, result.counts);
}

void RunTreeEngine::find_all(const RunTreeView& a, const PairTest& test, double bound,
                             QueryResult& result) const {
  std::unique_ptr<ContactBatch> batch;
  {
    const std::lock_guard lock(mutex_);
    if (!idle_batches_.empty()) {
      batch = std::move(idle_batches_.back());
      idle_batches_.pop_back();
    }
  }
  if (batch == nullptr) {
    batch = std::make_unique<ContactBatch>();
  }
  arena_.execute([&] { batch->find(a, tree_.view(), test, bound, result); });
  const std::lock_guard lock(mutex_);
  idle_batches_.push_back(std::move(batch));
}

// The root, which the tree has no box for, and the levels of the tree from the top down.
std::uint32_t RunTreeEngine::level_count() const {
  const std::uint32_t levels = tree_.view().level_count;
  return levels == 0 ? 0 : levels + 1;
}

void RunTreeEngine::level_boxes(std::uint32_t level, std::vector<NodeBox>& boxes) const {
  boxes.clear();
  const RunTreeView& tree = tree_.view();
  if (tree.level_count == 0) {
    return;
  }
  const std::uint32_t below_root = std::clamp(level, 1U, tree.level_count) - 1;
  const RunTreeLevel& shown = tree.levels[tree.level_count - 1 - below_root];
  for (std::uint32_t child = 0; child < shown.child_count; ++child) {
    const BoxBlock& block = shown.boxes[child / run_width];
    boxes.push_back({tree_.origin() + corner(block.lower, child % run_width),
                     tree_.origin() + corner(block.upper, child % run_width)});
  }
  if (level == 0) {
    for (const NodeBox& box : boxes) {
      boxes.front().lower = boxes.front().lower.cwiseMin(box.lower);
      boxes.front().upper = boxes.front().upper.cwiseMax(box.upper);
    }
    boxes.resize(1, boxes.front());
  }
}

double RunTreeEngine::mean_level_volume(std::uint32_t level) const {
  std::vector<NodeBox> boxes;
  level_boxes(level, boxes);
  double sum = 0.0;
  for (const NodeBox& box : boxes) {
    sum += (box.upper - box.lower).prod();
  }
  return boxes.empty() ? 0.0 : sum / static_cast<double>(boxes.size());
}

}  // namespace fiber

#include "src/cuda/cuda_tree_engine.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "src/bounds/bounding_volume.hpp"
#include "src/cuda/device_fibers.hpp"
#include "src/hierarchy/pair_bound.hpp"
#include "src/query/threads.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

// Pairs that are found and sorted at once: 16 bytes each on the device.
constexpr std::uint64_t max_pairs_at_once = std::uint64_t{1} << 28U;

// Where there are more than that, or where one after the other is asked about.
constexpr std::uint32_t leaves_a_piece = 4096;
constexpr std::uint64_t max_pairs_of_piece = std::uint64_t{1} << 22U;

// Where few of the closest pairs are asked for, all within a distance that grows are looked at,
// from this part of the extent on, by this factor.
constexpr double first_part_of_extent = 0x1p-12;
constexpr double growth = 8.0;

/// @param radii memory for those of segments, if these fibres have more than one
void update(DeviceTree& tree, const FiberAssembly& fibers, const Vector3d& origin,
            bool same_topology, std::vector<double>& radii) {
  require_tree_size(fibers.segment_count());
  if (!same_topology) {
    tree.set_topology(topology_of(fibers.offsets()));
  }
  HostFibers host = host_fibers(fibers, radii);
  host.coordinates = fibers.points().empty() ? nullptr : fibers.points().front().data();
  Eigen::Map<Vector3d>(host.origin) = origin;
  tree.update(host);
}

PairRule rule_of(const QueryOptions& options, bool self, double bound) {
  PairRule rule = pair_rule(bound, options.neighbour_skip.value_or(1), options.pairing);
  rule.self = self;
  return rule;
}

/// Whether the rule of the device leaves out all pairs that NarrowPhase does.
bool rule_is_whole(const QueryOptions& options, const FiberAssembly& fibers) {
  return options.neighbour_skip_length.value_or(0.0) == 0.0 && fibers.graph() == nullptr;
}

/// Whether a few of the nearest pairs answer the query.
bool needs_few(const QueryOptions& options) {
  return options.type == QueryType::FIRST || options.type == QueryType::CLOSEST ||
         options.type == QueryType::LIMITED;
}

/// Whether no pair that is further apart than the bound [m] matters any more.
bool is_answered(const QueryOptions& options, const QueryResult& result, double bound) {
  const std::uint64_t wanted =
      options.type == QueryType::LIMITED ? QueryLimits(options).contacts : 1;
  if (result.contacts.size() < wanted) {
    return false;
  }
  return options.type == QueryType::FIRST ||
         std::all_of(result.contacts.begin(), result.contacts.end(),
                     [&](const Contact& contact) { return contact.distance <= bound; });
}

/// [m] No two of these points are further apart than twice this.
double extent_of(const FiberAssembly& a, const FiberAssembly& b) {
  double extent = 0.0;
  for (const FiberAssembly* const fibers : {&a, &b}) {
    for (const Vector3d& point : fibers->points()) {
      extent = std::max(extent, (point - b.points().front()).cwiseAbs().maxCoeff());
    }
  }
  constexpr double diagonal = 2.0;  // at least the root of 3
  return diagonal * extent;
}

}  // namespace

struct CudaTreeEngine::Subject {
  const FiberAssembly* shape;  // null: the fibres
  const FiberAssembly& fibers;
  const DeviceTree& a;
  const DeviceTree& b;
  const LoopTest* loops;

  const FiberAssembly& fibers_a() const { return shape != nullptr ? *shape : fibers; }
  NarrowPhase narrow_phase(const QueryOptions& options) const {
    return shape != nullptr ? NarrowPhase(*shape, fibers, options)
                            : NarrowPhase(fibers, options, loops);
  }
};

/// One query at a time has the device. A thread that waits for others while it has it takes up
/// nothing but what these do: another query would wait for itself.
template <class Call>
void CudaTreeEngine::with_device(const Call& call) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  tbb::this_task_arena::isolate(call);
}

CudaTreeEngine::CudaTreeEngine(std::unique_ptr<Device> device, const EngineOptions& options)
    : arena_(arena_concurrency(options.threads)),
      device_(std::move(device)),
      tree_(device_->make_tree()) {}

CudaTreeEngine::~CudaTreeEngine() = default;

EngineFacts CudaTreeEngine::facts() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  EngineFacts facts;
  facts.thread_count = static_cast<std::uint32_t>(arena_.max_concurrency());
  facts.memory_bytes = tree_->memory_bytes() + device_->memory_bytes() + loops_.memory_bytes();
  facts.device_seconds = seconds_of(tree_->stages()) + seconds_of(device_->stages());
  return facts;
}

void CudaTreeEngine::do_update(const FiberAssembly& fibers, bool same_topology) {
  loops_.reset(fibers);
  arena_.execute(
      [&] { fiber::update(*tree_, fibers, hierarchy_origin(fibers), same_topology, radii_); });
}

void CudaTreeEngine::do_query(const FiberAssembly& fibers, const QueryOptions& options,
                              QueryResult& result) const {
  query({nullptr, fibers, *tree_, *tree_, &loops_}, options, result);
}

void CudaTreeEngine::do_query_shape(const FiberAssembly& shape, const FiberAssembly& fibers,
                                    const QueryOptions& options, QueryResult& result) const {
  std::unique_ptr<DeviceTree> tree;
  with_device([&] {
    std::vector<double> radii;
    tree = device_->make_tree();
    fiber::update(*tree, shape, hierarchy_origin(fibers), false, radii);
  });
  query({&shape, fibers, *tree, *tree_, nullptr}, options, result);
}

void CudaTreeEngine::query(const Subject& subject, const QueryOptions& options,
                           QueryResult& result) const {
  memory_.lend([&](Memory& memory) {
    arena_.execute([&] {
      QueryOptions left = options;
      if (options.type == QueryType::ALL) {
        const QueryLimits limits(options);
        if (find_all(subject, subject.narrow_phase(options), options, limits, memory, result)) {
          return;
        }
        left.deadline = limits.deadline.left();
      }
      collect(subject, left, memory, result);
    });
  });
}

/// All contacts, from all candidates at once.
/// @return false, with no answer, if there are more of these than may be
bool CudaTreeEngine::find_all(const Subject& subject, const NarrowPhase& test,
                              const QueryOptions& options, const QueryLimits& limits,
                              Memory& memory, QueryResult& result) const {
  const std::uint64_t most = std::min(limits.pairs, max_pairs_at_once);
  const bool self = subject.shape == nullptr;
  if (find(subject, 0, subject.a.view().leaf_count(), rule_of(options, self, options.margin), most,
           memory.keys) > most) {
    return false;
  }
  std::vector<std::uint64_t>& keys = memory.keys;
  result.counts.primitive_tests += keys.size();
  if (self && !rule_is_whole(options, subject.fibers)) {
    keys.erase(std::remove_if(keys.begin(), keys.end(),
                              [&](std::uint64_t key) { return test.is_left_out(pair_of(key)); }),
               keys.end());
  }
  memory.evaluator.evaluate(keys, test, limits, result);
  return true;
}

/// Answers the query from candidates, one by one.
void CudaTreeEngine::collect(const Subject& subject, const QueryOptions& options, Memory& memory,
                             QueryResult& result) const {
  const Deadline deadline(options.deadline);
  const FiberAssembly& a = subject.fibers_a();
  const bool is_empty = a.segment_count() == 0 || subject.fibers.segment_count() == 0;
  const double extent = is_empty ? 0.0 : extent_of(a, subject.fibers);
  QueryOptions left = options;
  double bound = needs_few(options) ? 0.0 : options.margin;
  for (;;) {
    bound = bound < extent ? std::min(bound, options.margin) : options.margin;
    std::optional<PairCollector> collector;
    if (subject.shape != nullptr) {
      collector.emplace(a, subject.fibers, left, result);
    } else {
      collector.emplace(subject.fibers, left, result, subject.loops);
    }
    const std::uint64_t offered =
        offer(subject, rule_of(options, subject.shape == nullptr, bound), *collector, memory.keys);
    const bool is_over = bound >= options.margin || collector->done_by_now();
    collector->finish();
    if (is_over || is_answered(options, result, bound)) {
      return;
    }
    if (options.pair_limit != 0) {
      left.pair_limit = std::max<std::uint64_t>(left.pair_limit - offered, 1);
    }
    left.deadline = deadline.left();
    bound = std::max(first_part_of_extent * extent, growth * bound);
  }
}

/// Offers the pairs that the rule allows, while more are wanted, in an order that does not depend
/// on how many there are.
/// @return how many it has offered
std::uint64_t CudaTreeEngine::offer(const Subject& subject, const PairRule& rule,
                                    PairCollector& collector,
                                    std::vector<std::uint64_t>& keys) const {
  std::uint64_t offered = 0;
  std::uint32_t piece = leaves_a_piece;
  const std::uint32_t leaves = subject.a.view().leaf_count();
  for (std::uint32_t leaf = 0; leaf < leaves && !collector.done_by_now();) {
    const std::uint32_t count = std::min(piece, leaves - leaf);
    const std::uint64_t most =
        count == 1 ? std::numeric_limits<std::uint64_t>::max() : max_pairs_of_piece;
    if (find(subject, leaf, count, rule, most, keys) > most) {
      piece = (count + 1) / 2;
      continue;
    }
    for (const std::uint64_t key : keys) {
      if (collector.done()) {
        return offered;
      }
      const PointPair pair = pair_of(key);
      collector.offer(pair.a, pair.b);
      ++offered;
    }
    leaf += count;
  }
  return offered;
}

std::uint64_t CudaTreeEngine::find(const Subject& subject, std::uint32_t first_leaf,
                                   std::uint32_t leaf_count, const PairRule& rule,
                                   std::uint64_t most, std::vector<std::uint64_t>& keys) const {
  std::uint64_t count = 0;
  with_device([&] {
    count = device_->find(subject.a, first_leaf, leaf_count, subject.b, rule, most, keys);
  });
  return count;
}

}  // namespace fiber

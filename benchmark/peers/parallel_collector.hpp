#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fiber_proximity/query/for_engines/pair_collector.hpp"
#include "fiber_proximity/query/options.hpp"
#include "src/hierarchy/sort_keys.hpp"
#include "src/query/contact_evaluator.hpp"

namespace fiber {

/// Decides about the pairs that a broad phase reports from several threads at once, with the narrow
/// phase that run_tree has. For QueryType::ALL only: the other types must see the pairs of all
/// threads. Keeps its memory from query to query.
class ParallelCollector {
 public:
  /// The pairs that one thread has found. Most pairs of boxes are no contacts: they are left out at
  /// once.
  class Part {
   public:
    /// Considers the segments that start at these points; each pair may be offered once.
    void offer(std::uint32_t point_a, std::uint32_t point_b) {
      const PointPair pair = test_->ordered({point_a, point_b});
      if (test_->is_left_out(pair)) {
        return;
      }
      waiting_[size_++] = pair;
      if (size_ == waiting_.size()) {
        flush();
      }
    }

   private:
    friend ParallelCollector;

    void begin(const NarrowPhase& test) {
      test_ = &test;
      keys_.clear();
      tests_ = 0;
    }

    void flush() {
      std::array<PairDistance, max_waiting> distances;
      test_->distances(waiting_.data(), size_, distances.data());
      for (std::size_t i = 0; i < size_; ++i) {
        if (test_->is_within_margin(waiting_[i], distances[i])) {
          keys_.push_back(pair_key(waiting_[i]));
        }
      }
      tests_ += size_;
      size_ = 0;
    }

    static constexpr std::size_t max_waiting = 256;

    const NarrowPhase* test_ = nullptr;
    std::array<PointPair, max_waiting> waiting_{};
    std::size_t size_ = 0;
    std::vector<std::uint64_t> keys_;
    std::uint64_t tests_ = 0;
  };

  /// Calls with the collector, whose local() part each thread offers to; then puts all together.
  /// @param collide called once
  template <class Collide>
  void collect(const FiberAssembly& fibers, const QueryOptions& options, QueryResult& result,
               const Collide& collide) {
    const NarrowPhase test(fibers, options);
    test_ = &test;
    for (Part& part : parts_) {
      part.begin(test);
    }
    collide(*this);
    keys_.clear();
    for (Part& part : parts_) {
      part.flush();
      keys_.insert(keys_.end(), part.keys_.begin(), part.keys_.end());
      result.counts.primitive_tests += part.tests_;
    }
    sort_keys(keys_, scratch_);
    evaluator_.evaluate(keys_, test, QueryLimits(QueryOptions()), result);
  }

  /// The calling thread's own.
  Part& local() {
    bool exists = false;
    Part& part = parts_.local(exists);
    if (!exists) {
      part.begin(*test_);
    }
    return part;
  }

 private:
  const NarrowPhase* test_ = nullptr;
  tbb::enumerable_thread_specific<Part> parts_;
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint64_t> scratch_;
  ContactEvaluator evaluator_;
};

}  // namespace fiber

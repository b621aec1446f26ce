#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "src/hierarchy/segment_boxes.hpp"
#include "src/query/threads.hpp"

namespace fiber {

/// The threads of a peer that uses several. What is called here, and the library inside it, gets by
/// with them.
class PeerThreads {
 public:
  explicit PeerThreads(std::uint32_t limit)
      : arena_(arena_concurrency(limit)),
        count_(static_cast<std::uint32_t>(arena_.max_concurrency())) {}

  std::uint32_t count() const { return count_; }

  template <class Call>
  void run(const Call& call) const {
    arena_.execute(call);
  }

  /// boxes.update(), shared out.
  void update(SegmentBoxes& boxes, const FiberAssembly& fibers, bool same_topology) const {
    if (!same_topology) {
      boxes.reset(fibers);
    }
    for_ranges(boxes.size(),
               [&](std::size_t begin, std::size_t end) { boxes.fit(fibers, begin, end); });
  }

  /// Calls call(begin, end) with ranges that together are those from 0 to before `size`.
  template <class Call>
  void for_ranges(std::size_t size, const Call& call) const {
    constexpr std::size_t grain = 4096;
    run([&] {
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, size, grain),
          [&](const tbb::blocked_range<std::size_t>& range) { call(range.begin(), range.end()); });
    });
  }

 private:
  mutable tbb::task_arena arena_;
  std::uint32_t count_;
};

}  // namespace fiber

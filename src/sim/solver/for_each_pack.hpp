#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>

namespace fiber {

/// What is to be done for a pack: sums and copies, or what takes as long as its energy or its band.
enum class Work { LITTLE, MUCH };

/// Calls function(pack) for so many packs; in parallel, but little work only if there is more of
/// it: one pack is done before another thread has heard of it.
template <class Function>
void for_each_pack(std::size_t count, Work work, const Function& function) {
  using Range = tbb::blocked_range<std::size_t>;
  const Range all(0, count, work == Work::MUCH ? 1 : 16);
  const auto run = [&](const Range& range) {
    for (std::size_t pack = range.begin(); pack < range.end(); ++pack) {
      function(pack);
    }
  };
  if (all.is_divisible()) {
    tbb::parallel_for(all, run);
  } else {
    run(all);
  }
}

}  // namespace fiber

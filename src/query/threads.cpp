#include "src/query/threads.hpp"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <stdexcept>
#include <string>

namespace fiber {

void validate_threads(std::uint32_t threads) {
  if (threads > max_threads) {
    throw std::invalid_argument("threads is " + std::to_string(threads) + ", it must be at most " +
                                std::to_string(max_threads) +
                                " (0 for as many as there are cores)");
  }
}

int arena_concurrency(std::uint32_t threads) {
  validate_threads(threads);
  if (threads == 0) {
    return tbb::task_arena::automatic;
  }
  const std::size_t allowed =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return static_cast<int>(std::min<std::size_t>(threads, allowed));
}

}  // namespace fiber

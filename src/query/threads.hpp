#pragma once

#include <tbb/parallel_for.h>

#include <cstddef>
#include <cstdint>

#include "fiber_proximity/export.hpp"

namespace fiber {

/// The most threads that may be asked for; more cores than most machines have.
constexpr std::uint32_t max_threads = 1024;

/// @throws std::invalid_argument naming the value and what is allowed, if that is more
FIBER_PROXIMITY_EXPORT void validate_threads(std::uint32_t threads);

/// The concurrency of a tbb::task_arena for at most this many threads, 0 for as many as there are
/// cores. It is never above what TBB allows (the cores of this process, or what a
/// tbb::global_control says): TBB would write a warning to stderr and use no more of them.
/// @throws std::invalid_argument as validate_threads
FIBER_PROXIMITY_EXPORT int arena_concurrency(std::uint32_t threads);

/// Calls for 0 … count − 1, on several threads if that is more than one thread is woken for.
template <class Call>
void for_each_of(std::size_t count, const Call& call) {
  constexpr std::size_t worth_a_thread = 3;
  if (count < worth_a_thread) {
    for (std::size_t i = 0; i < count; ++i) {
      call(i);
    }
    return;
  }
  tbb::parallel_for(std::size_t{0}, count, call);
}

}  // namespace fiber

#pragma once

#include <tbb/parallel_for.h>

#include <cstddef>

namespace fiber {

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

#pragma once

#include <ctime>

namespace fiber {

/// Time a call takes of all processors [ms]: for what one thread does, without what else the
/// machine is busy with.
template <class Call>
double processor_time_of(const Call& call) {
  const auto now_ms = [] {
    std::timespec time = {};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);  // std::clock() tells microseconds only
    return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
  };
  const double start_ms = now_ms();
  call();
  return now_ms() - start_ms;
}

}  // namespace fiber

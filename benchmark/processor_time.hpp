#pragma once

#include <ctime>

namespace fiber {

/// Time a call takes of all processors [ms]: for what one thread does, without what else the
/// machine is busy with.
template <class Call>
double processor_time_of(const Call& call) {
  const std::clock_t start = std::clock();
  call();
  return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

}  // namespace fiber

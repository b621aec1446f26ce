#include "src/cuda/pinned_copy.hpp"

#include <algorithm>
#include <cstring>

#include "src/query/threads.hpp"

namespace fiber {

void copy_on_threads(void* to, const void* from, std::size_t bytes) {
  constexpr std::size_t bytes_a_job = std::size_t{1} << 18U;
  for_each_of((bytes + bytes_a_job - 1) / bytes_a_job, [&](std::size_t job) {
    const std::size_t begin = job * bytes_a_job;
    std::memcpy(static_cast<char*>(to) + begin, static_cast<const char*>(from) + begin,
                std::min(bytes_a_job, bytes - begin));
  });
}

}  // namespace fiber

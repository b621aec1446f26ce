#include "benchmark/kernels/guarded_calls.hpp"

#include <sys/time.h>

#include <stdexcept>

#include "benchmark/kernels/child_process.hpp"

namespace fiber {
namespace {

/// Ends the process after a second of computing, waiting not counted; from now on.
void set_alarm() {
  const itimerval second{{0, 0}, {1, 0}};
  setitimer(ITIMER_VIRTUAL, &second, nullptr);
}

}  // namespace

void guarded_calls(std::size_t count, const std::function<void(std::size_t)>& call) {
  const SharedArray<volatile std::size_t> begun(1);  // calls
  while (begun[0] < count) {
    const std::size_t before = begun[0];
    survives([&] {
      while (begun[0] < count) {
        const std::size_t index = begun[0];
        begun[0] = index + 1;
        set_alarm();
        call(index);
      }
    });
    if (begun[0] == before) {
      throw std::runtime_error("a child process ended before it began");
    }
  }
}

}  // namespace fiber

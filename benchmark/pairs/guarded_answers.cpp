#include "pairs/guarded_answers.hpp"

#include <sys/time.h>

#include <cmath>
#include <stdexcept>

#include "pairs/child_process.hpp"

namespace fiber {
namespace {

GuardedAnswer ask(PairKernel& kernel, std::size_t index) {
  GuardedAnswer result;
  try {
    result.answer = kernel.answer(index);
    result.outcome =
        std::isfinite(result.answer.distance) ? Outcome::ANSWERED : Outcome::NOT_FINITE;
  } catch (const std::exception&) {
    result.outcome = Outcome::NO_ANSWER;
  }
  return result;
}

/// Ends the process after a second of computing, waiting not counted; from now on.
void set_alarm() {
  const itimerval second{{0, 0}, {1, 0}};
  setitimer(ITIMER_VIRTUAL, &second, nullptr);
}

}  // namespace

std::vector<GuardedAnswer> guarded_answers(PairKernel& kernel, std::size_t count) {
  static_assert(static_cast<int>(Outcome::ENDED) == 0, "what shared memory has at first");
  const SharedArray<GuardedAnswer> answers(count);
  const SharedArray<volatile std::size_t> begun(1);  // pairs
  while (begun[0] < count) {
    const std::size_t before = begun[0];
    survives([&] {
      while (begun[0] < count) {
        const std::size_t index = begun[0];
        begun[0] = index + 1;
        set_alarm();
        answers[index] = ask(kernel, index);
      }
    });
    if (begun[0] == before) {
      throw std::runtime_error("a child process ended before it began");
    }
  }
  return {answers.begin(), answers.end()};
}

}  // namespace fiber

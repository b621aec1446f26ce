#include "benchmark/pairs/guarded_answers.hpp"

#include <cmath>
#include <stdexcept>

#include "benchmark/pairs/child_process.hpp"
#include "benchmark/pairs/guarded_calls.hpp"

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

}  // namespace

std::vector<GuardedAnswer> guarded_answers(PairKernel& kernel, std::size_t count) {
  static_assert(static_cast<int>(Outcome::ENDED) == 0, "what shared memory has at first");
  const SharedArray<GuardedAnswer> answers(count);
  guarded_calls(count, [&](std::size_t index) { answers[index] = ask(kernel, index); });
  return {answers.begin(), answers.end()};
}

}  // namespace fiber

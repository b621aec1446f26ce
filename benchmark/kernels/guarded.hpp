#pragma once

#include <cstddef>
#include <exception>
#include <vector>

#include "benchmark/kernels/child_process.hpp"
#include "benchmark/kernels/guarded_calls.hpp"

namespace fiber {

/// How a call of a kernel ended.
enum class Outcome {
  ENDED,       ///< the process aborted, or was ended after a second of computing
  NO_ANSWER,   ///< an exception
  NOT_FINITE,  ///< a number that is none
  ANSWERED
};

template <class Answer>
struct Guarded {
  Outcome outcome = Outcome::ENDED;
  Answer answer;  ///< if it is ANSWERED
};

/// The answers ask(index) to `count` questions, by guarded_calls(). No other thread may be running.
/// @param is_finite whether an answer has numbers that are some
/// @throws std::runtime_error if there are no more processes or memory
template <class Answer, class Ask, class IsFinite>
std::vector<Guarded<Answer>> guarded_answers(std::size_t count, const Ask& ask,
                                             const IsFinite& is_finite) {
  static_assert(static_cast<int>(Outcome::ENDED) == 0, "what shared memory has at first");
  const SharedArray<Guarded<Answer>> answers(count);
  guarded_calls(count, [&](std::size_t index) {
    Guarded<Answer> result;
    try {
      result.answer = ask(index);
      result.outcome = is_finite(result.answer) ? Outcome::ANSWERED : Outcome::NOT_FINITE;
    } catch (const std::exception&) {
      result.outcome = Outcome::NO_ANSWER;
    }
    answers[index] = result;
  });
  return {answers.begin(), answers.end()};
}

}  // namespace fiber

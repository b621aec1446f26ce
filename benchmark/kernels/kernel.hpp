#pragma once

#include <cstddef>
#include <vector>

namespace fiber {

/// A way to answer questions of one kind, ours or another library's.
template <class QuestionType, class AnswerType>
class BenchmarkKernel {
 public:
  using Question = QuestionType;
  using Answer = AnswerType;

  BenchmarkKernel() = default;
  BenchmarkKernel(const BenchmarkKernel&) = delete;
  BenchmarkKernel& operator=(const BenchmarkKernel&) = delete;
  virtual ~BenchmarkKernel() = default;

  /// Makes of the questions what the kernel works on. This is not measured: whoever uses another
  /// library has its objects. The questions live until the next call.
  virtual void prepare(const std::vector<Question>& questions) = 0;

  /// Answers `count` questions from the one with index `first` on. This is measured.
  virtual void run(std::size_t first, std::size_t count, Answer* answers) = 0;
};

}  // namespace fiber

#pragma once

#include <utility>
#include <vector>

#include "benchmark/kernels/turn_times.hpp"

namespace fiber {

/// Questions to a kernel, the times of which are compared with those of others.
template <class Kernel>
class KernelCalls final : public TimedCalls {
 public:
  using Question = typename Kernel::Question;

  explicit KernelCalls(Kernel& kernel, std::vector<Question> questions = {})
      : kernel_(kernel), questions_(std::move(questions)) {}

  void add(const Question& question) { questions_.push_back(question); }

  std::size_t size() const override { return questions_.size(); }

  void prepare() override {
    kernel_.prepare(questions_);
    answers_.resize(questions_.size());
  }

  void call(std::size_t first, std::size_t count) override {
    kernel_.run(first, count, answers_.data());
  }

  void leave_out(std::size_t first, std::size_t count) override {
    std::vector<Question> left(questions_.begin(),
                               questions_.begin() + static_cast<std::ptrdiff_t>(first));
    left.insert(left.end(), questions_.begin() + static_cast<std::ptrdiff_t>(first + count),
                questions_.end());
    questions_.swap(left);
  }

 private:
  Kernel& kernel_;
  std::vector<Question> questions_;
  std::vector<typename Kernel::Answer> answers_;
};

}  // namespace fiber

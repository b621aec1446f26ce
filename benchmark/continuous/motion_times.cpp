#include "benchmark/continuous/motion_times.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "benchmark/pairs/child_process.hpp"
#include "benchmark/pairs/guarded_calls.hpp"
#include "benchmark/pairs/turn_times.hpp"
#include "benchmark/peers/translation.hpp"

namespace fiber {
namespace {

/// Motions of one kind, whose times are measured.
class MotionCalls final : public TimedCalls {
 public:
  explicit MotionCalls(const MotionContestant& contestant)
      : kernel_(contestant.make()), tolerance_(contestant.tolerance) {}

  void add(const HardMotion& motion) { motions_.push_back(motion); }

  std::size_t size() const override { return motions_.size(); }

  void prepare() override {
    kernel_->prepare(motions_, tolerance_);
    times_.resize(motions_.size());
  }

  void call(std::size_t first, std::size_t count) override {
    kernel_->find(first, count, times_.data());
  }

  void leave_out(std::size_t first, std::size_t count) override {
    std::vector<HardMotion> left;
    for (std::size_t i = 0; i < motions_.size(); ++i) {
      if (i < first || i >= first + count) {
        left.push_back(motions_[i]);
      }
    }
    motions_.swap(left);
  }

 private:
  const std::unique_ptr<MotionKernel> kernel_;
  const double tolerance_;  // [m]
  std::vector<HardMotion> motions_;
  std::vector<ContactTime> times_;
};

GuardedTime ask_about(MotionKernel& kernel, std::size_t index) {
  GuardedTime result;
  try {
    kernel.find(index, 1, &result.time);
    const bool is_time = !result.time.hit || !(std::isnan(result.time.upper));
    result.outcome = is_time ? Outcome::ANSWERED : Outcome::NOT_FINITE;
  } catch (const std::exception&) {
    result.outcome = Outcome::NO_ANSWER;
  }
  return result;
}

/// One contestant and all motions.
class MotionRun {
 public:
  MotionRun(const std::vector<HardMotion>& motions, const std::vector<MotionTruth>& truths,
            const MotionContestant& contestant)
      : rejected_(contestant), hits_(contestant) {
    result_.translations =
        static_cast<std::uint64_t>(std::count_if(motions.begin(), motions.end(), is_translation));
    const std::unique_ptr<MotionKernel> kernel = contestant.make();
    std::vector<HardMotion> known;
    std::vector<MotionTruth> known_truths;
    for (std::size_t i = 0; i < motions.size(); ++i) {
      if (kernel->can_answer(motions[i])) {
        known.push_back(motions[i]);
        known_truths.push_back(truths[i]);
      }
    }
    result_.answerable = known.size();
    for (const MotionTruth& truth : known_truths) {
      result_.contacts += truth.contact ? 1 : 0;
      result_.near += truth.near && !truth.contact ? 1 : 0;
      result_.undecided += truth.undecided ? 1 : 0;
    }
    kernel->prepare(known, contestant.tolerance);
    ask(*kernel, known, known_truths);
  }

  TimedCalls& rejected() { return rejected_; }
  TimedCalls& hits() { return hits_; }

  MotionKernelResult result(const std::vector<BlockTime>& rejected,
                            const std::vector<BlockTime>& hits) const {
    MotionKernelResult result = result_;
    std::tie(result.rejected, result.rejected_ns) = together(rejected);
    std::tie(result.hits, result.hit_ns) = together(hits);
    return result;
  }

 private:
  void ask(MotionKernel& kernel, const std::vector<HardMotion>& motions,
           const std::vector<MotionTruth>& truths) {
    const SharedArray<GuardedTime> times(motions.size());
    guarded_calls(motions.size(), [&](std::size_t i) { times[i] = ask_about(kernel, i); });
    for (std::size_t i = 0; i < motions.size(); ++i) {
      result_.score.add(motions[i], truths[i], times[i]);
      if (times[i].outcome != Outcome::ANSWERED) {
        continue;
      }
      if (truths[i].contact) {
        hits_.add(motions[i]);
      } else if (!truths[i].near) {
        rejected_.add(motions[i]);
      }
    }
  }

  static std::pair<std::uint64_t, std::optional<double>> together(
      const std::vector<BlockTime>& blocks) {
    std::uint64_t motions = 0;
    double sum_ns = 0.0;
    for (const BlockTime& block : blocks) {
      motions += block.items;
      sum_ns += block.item_ns * static_cast<double>(block.items);
    }
    if (motions == 0) {
      return {0, std::nullopt};
    }
    return {motions, sum_ns / static_cast<double>(motions)};
  }

  MotionKernelResult result_;
  MotionCalls rejected_;
  MotionCalls hits_;
};

}  // namespace

std::vector<MotionKernelResult> motion_results(const std::vector<HardMotion>& motions,
                                               const std::vector<MotionContestant>& contestants,
                                               std::uint32_t repeats) {
  std::map<double, std::vector<MotionTruth>> truths;  // by tolerance
  std::vector<std::unique_ptr<MotionRun>> runs;
  std::vector<TimedCalls*> calls;
  for (const MotionContestant& contestant : contestants) {
    std::vector<MotionTruth>& known = truths[contestant.tolerance];
    if (known.empty()) {
      for (const HardMotion& motion : motions) {
        known.emplace_back(motion, contestant.tolerance);
      }
    }
    runs.push_back(std::make_unique<MotionRun>(motions, known, contestant));
    calls.insert(calls.end(), {&runs.back()->rejected(), &runs.back()->hits()});
  }
  TurnSizes sizes;
  sizes.repeats = repeats;
  sizes.block = 256;
  const std::vector<std::vector<BlockTime>> times = turn_times(calls, sizes);
  std::vector<MotionKernelResult> results;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    results.push_back(runs[i]->result(times[2 * i], times[2 * i + 1]));
  }
  return results;
}

}  // namespace fiber

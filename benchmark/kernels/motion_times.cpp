#include "benchmark/kernels/motion_times.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "benchmark/kernels/guarded.hpp"
#include "benchmark/kernels/kernel_calls.hpp"
#include "benchmark/peers/translation.hpp"

namespace fiber {
namespace {

/// A new kernel that is asked with the contestant's tolerance.
std::unique_ptr<MotionKernel> kernel_of(const MotionContestant& contestant) {
  std::unique_ptr<MotionKernel> kernel = contestant.make();
  kernel->set_tolerance(contestant.tolerance);
  return kernel;
}

/// One contestant and all motions.
class MotionRun {
 public:
  MotionRun(const std::vector<HardMotion>& motions, const std::vector<MotionTruth>& truths,
            const MotionContestant& contestant)
      : rejecting_(kernel_of(contestant)),
        hitting_(kernel_of(contestant)),
        rejected_(*rejecting_),
        hits_(*hitting_) {
    result_.translations =
        static_cast<std::uint64_t>(std::count_if(motions.begin(), motions.end(), is_translation));
    const std::unique_ptr<MotionKernel> kernel = kernel_of(contestant);
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
    kernel->prepare(known);
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
    const std::vector<Guarded<ContactTime>> times = guarded_answers<ContactTime>(
        motions.size(),
        [&](std::size_t i) {
          ContactTime time;
          kernel.run(i, 1, &time);
          return time;
        },
        [](const ContactTime& time) { return !time.hit || !std::isnan(time.upper); });
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
  std::unique_ptr<MotionKernel> rejecting_;
  std::unique_ptr<MotionKernel> hitting_;
  KernelCalls<MotionKernel> rejected_;
  KernelCalls<MotionKernel> hits_;
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

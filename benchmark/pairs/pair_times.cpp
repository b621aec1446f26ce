#include "benchmark/pairs/pair_times.hpp"

#include <memory>

#include "benchmark/pairs/turn_times.hpp"

namespace fiber {
namespace {

class PairCalls final : public TimedCalls {
 public:
  explicit PairCalls(TimedKernel timed) : timed_(std::move(timed)), results_(timed_.pairs.size()) {}

  std::size_t size() const override { return timed_.pairs.size(); }

  void prepare() override { timed_.kernel->prepare(timed_.pairs); }

  void call(std::size_t first, std::size_t count) override {
    timed_.kernel->distances(first, count, results_.data());
  }

  void leave_out(std::size_t first, std::size_t count) override {
    const auto begin = timed_.pairs.begin() + static_cast<std::ptrdiff_t>(first);
    timed_.pairs.erase(begin, begin + static_cast<std::ptrdiff_t>(count));
  }

 private:
  TimedKernel timed_;
  std::vector<double> results_;
};

}  // namespace

std::vector<std::vector<double>> pair_times_ns(std::vector<TimedKernel> kernels,
                                               std::uint32_t repeats) {
  std::vector<std::unique_ptr<PairCalls>> owned;
  std::vector<TimedCalls*> calls;
  for (TimedKernel& kernel : kernels) {
    owned.push_back(std::make_unique<PairCalls>(std::move(kernel)));
    calls.push_back(owned.back().get());
  }
  constexpr std::size_t block = 32;
  constexpr double slow_ns = 1000.0;
  std::vector<std::vector<double>> result;
  for (const std::vector<BlockTime>& blocks : turn_times(calls, {repeats, block, slow_ns})) {
    std::vector<double> times;
    for (const BlockTime& time : blocks) {
      times.push_back(time.item_ns);
    }
    result.push_back(std::move(times));
  }
  return result;
}

}  // namespace fiber

#include "benchmark/kernels/pair_times.hpp"

#include <memory>

#include "benchmark/kernels/kernel_calls.hpp"

namespace fiber {

std::vector<std::vector<double>> pair_times_ns(std::vector<TimedKernel> kernels,
                                               std::uint32_t repeats) {
  std::vector<std::unique_ptr<KernelCalls<PairKernel>>> owned;
  std::vector<TimedCalls*> calls;
  for (TimedKernel& timed : kernels) {
    owned.push_back(
        std::make_unique<KernelCalls<PairKernel>>(*timed.kernel, std::move(timed.pairs)));
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

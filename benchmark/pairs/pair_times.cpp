#include "pairs/pair_times.hpp"

#include <algorithm>
#include <stdexcept>

#include "pairs/child_process.hpp"
#include "statistics.hpp"

namespace fiber {
namespace {

constexpr double nano_per_milli = 1e6;
constexpr std::size_t pairs_per_turn = 32;
constexpr double slow_ns = 1000.0;  // per call: each pair on its own

/// Which kernel is at work on which pairs.
struct Turn {
  std::size_t kernel;
  std::size_t first;
  std::size_t count;
};

/// What reading the clock adds to a time [ns].
double clock_ns() {
  std::vector<double> times;
  for (int i = 0; i < 1000; ++i) {
    times.push_back(nano_per_milli * time_of([] {}));
  }
  return median(times);
}

/// One kernel's turns and what they took.
class Turns {
 public:
  Turns(PairKernel& kernel, std::size_t index, std::size_t count, volatile Turn& turn)
      : kernel_(kernel), index_(index), count_(count), turn_(turn), results_(count) {}

  /// Decides about the size of blocks.
  void warm_up(double clock_ns) {
    clock_ns_ = clock_ns;
    std::vector<double> singly;
    for (std::size_t i = 0; i < count_; ++i) {
      singly.push_back(time_ns(i, 1));
    }
    // Not the mean: one interruption would make a kernel slow.
    block_ = !singly.empty() && median(singly) > slow_ns ? 1 : pairs_per_turn;
    samples_.resize((count_ + block_ - 1) / block_);
  }

  void take(std::size_t first) {
    const std::size_t end = std::min(count_, first + pairs_per_turn);
    for (std::size_t i = first; i < end; i += block_) {
      const std::size_t size = std::min(block_, end - i);
      if (block_ > 1) {
        time_ns(i, size);  // as in use, where no other kernel has just filled the caches
      }
      samples_[i / block_].push_back(time_ns(i, size) / static_cast<double>(size));
    }
  }

  /// Writes the median of every block; how many there are.
  std::size_t write_medians(double* times) const {
    std::transform(samples_.begin(), samples_.end(), times,
                   [](const std::vector<double>& block) { return median(block); });
    return samples_.size();
  }

 private:
  double time_ns(std::size_t first, std::size_t count) {
    turn_.kernel = index_;
    turn_.first = first;
    turn_.count = count;
    const double time =
        nano_per_milli * time_of([&] { kernel_.distances(first, count, results_.data()); });
    return std::max(0.0, time - clock_ns_);
  }

  PairKernel& kernel_;
  std::size_t index_;
  std::size_t count_;
  volatile Turn& turn_;  // in shared memory, for whom it may concern
  double clock_ns_ = 0.0;
  std::vector<double> results_;
  std::size_t block_ = pairs_per_turn;
  std::vector<std::vector<double>> samples_;  // of each block one per repeat
};

void take_turns(std::vector<Turns>& turns, std::size_t most, std::uint32_t repeats) {
  const double clock = clock_ns();
  for (Turns& each : turns) {
    each.warm_up(clock);
  }
  for (std::uint32_t repeat = 0; repeat < repeats; ++repeat) {
    for (std::size_t first = 0; first < most; first += pairs_per_turn) {
      for (std::size_t turn = 0; turn < turns.size(); ++turn) {
        turns[(repeat + turn) % turns.size()].take(first);
      }
    }
  }
}

}  // namespace

std::vector<std::vector<double>> pair_times_ns(std::vector<TimedKernel> kernels,
                                               std::uint32_t repeats) {
  std::size_t most = 0;
  for (const TimedKernel& each : kernels) {
    most = std::max(most, each.pairs.size());
  }
  const SharedArray<volatile Turn> turn(1);
  const SharedArray<double> times(kernels.size() * most);
  const SharedArray<std::size_t> sizes(kernels.size());
  for (;;) {
    std::vector<Turns> turns;
    for (std::size_t i = 0; i < kernels.size(); ++i) {
      kernels[i].kernel->prepare(kernels[i].pairs);
      turns.emplace_back(*kernels[i].kernel, i, kernels[i].pairs.size(), turn[0]);
    }
    turn[0].count = 0;
    const bool done = survives([&] {
      take_turns(turns, most, repeats);
      for (std::size_t i = 0; i < turns.size(); ++i) {
        sizes[i] = turns[i].write_medians(&times[i * most]);
      }
    });
    if (done) {
      break;
    }
    if (turn[0].count == 0) {
      throw std::runtime_error("a child process ended before it measured anything");
    }
    std::vector<HardPair>& pairs = kernels[turn[0].kernel].pairs;
    const auto first = pairs.begin() + static_cast<std::ptrdiff_t>(turn[0].first);
    pairs.erase(first, first + static_cast<std::ptrdiff_t>(turn[0].count));
  }
  std::vector<std::vector<double>> result;
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    const double* const begin = &times[i * most];
    result.emplace_back(begin, begin + sizes[i]);
  }
  return result;
}

}  // namespace fiber

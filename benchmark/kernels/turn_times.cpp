#include "benchmark/kernels/turn_times.hpp"

#include <algorithm>
#include <stdexcept>

#include "benchmark/kernels/child_process.hpp"
#include "src/accuracy/statistics.hpp"

namespace fiber {
namespace {

constexpr double nano_per_milli = 1e6;

/// Which calls are at work on which items.
struct Turn {
  std::size_t calls;
  std::size_t first;
  std::size_t count;
};

/// The time that reading the clock adds [ns].
double clock_ns() {
  std::vector<double> times;
  for (int i = 0; i < 1000; ++i) {
    times.push_back(nano_per_milli * time_of([] {}));
  }
  return median(times);
}

/// One's turns and what they took.
class Turns {
 public:
  Turns(TimedCalls& calls, std::size_t index, const TurnSizes& sizes, volatile Turn& turn)
      : calls_(calls), index_(index), count_(calls.size()), sizes_(sizes), turn_(turn) {}

  /// Decides about the size of blocks.
  void warm_up(double clock_ns) {
    clock_ns_ = clock_ns;
    std::vector<double> singly;
    for (std::size_t i = 0; i < count_; ++i) {
      singly.push_back(time_ns(i, 1));
    }
    // Not the mean: one interruption would make a kernel slow.
    block_ = !singly.empty() && median(singly) > sizes_.slow_ns ? 1 : sizes_.block;
    samples_.resize((count_ + block_ - 1) / block_);
  }

  void take(std::size_t first) {
    const std::size_t end = std::min(count_, first + sizes_.block);
    for (std::size_t i = first; i < end; i += block_) {
      const std::size_t size = std::min(block_, end - i);
      if (block_ > 1) {
        time_ns(i, size);  // as in use, where no other kernel has just filled the caches
      }
      samples_[i / block_].push_back(time_ns(i, size) / static_cast<double>(size));
    }
  }

  /// Writes the time of every block; how many there are.
  std::size_t write_times(BlockTime* times) const {
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      times[i] = {median(samples_[i]), std::min(block_, count_ - i * block_)};
    }
    return samples_.size();
  }

 private:
  double time_ns(std::size_t first, std::size_t count) {
    turn_.calls = index_;
    turn_.first = first;
    turn_.count = count;
    const double time = nano_per_milli * time_of([&] { calls_.call(first, count); });
    return std::max(0.0, time - clock_ns_);
  }

  TimedCalls& calls_;
  std::size_t index_;
  std::size_t count_;
  TurnSizes sizes_;
  volatile Turn& turn_;  // in shared memory, for whom it may concern
  double clock_ns_ = 0.0;
  std::size_t block_ = 1;
  std::vector<std::vector<double>> samples_;  // of each block one per repeat
};

void take_turns(std::vector<Turns>& turns, std::size_t most, const TurnSizes& sizes) {
  const double clock = clock_ns();
  for (Turns& each : turns) {
    each.warm_up(clock);
  }
  for (std::uint32_t repeat = 0; repeat < sizes.repeats; ++repeat) {
    for (std::size_t first = 0; first < most; first += sizes.block) {
      for (std::size_t turn = 0; turn < turns.size(); ++turn) {
        turns[(repeat + turn) % turns.size()].take(first);
      }
    }
  }
}

}  // namespace

std::vector<std::vector<BlockTime>> turn_times(const std::vector<TimedCalls*>& calls,
                                               const TurnSizes& sizes) {
  std::size_t most = 0;
  for (const TimedCalls* each : calls) {
    most = std::max(most, each->size());
  }
  const SharedArray<volatile Turn> turn(1);
  const SharedArray<BlockTime> times(calls.size() * most);
  const SharedArray<std::size_t> counts(calls.size());  // of blocks
  for (;;) {
    std::vector<Turns> turns;
    for (std::size_t i = 0; i < calls.size(); ++i) {
      calls[i]->prepare();
      turns.emplace_back(*calls[i], i, sizes, turn[0]);
    }
    turn[0].count = 0;
    const bool done = survives([&] {
      take_turns(turns, most, sizes);
      for (std::size_t i = 0; i < turns.size(); ++i) {
        counts[i] = turns[i].write_times(&times[i * most]);
      }
    });
    if (done) {
      break;
    }
    if (turn[0].count == 0) {
      throw std::runtime_error("a child process ended before it measured anything");
    }
    calls[turn[0].calls]->leave_out(turn[0].first, turn[0].count);
  }
  std::vector<std::vector<BlockTime>> result;
  for (std::size_t i = 0; i < calls.size(); ++i) {
    const BlockTime* const begin = &times[i * most];
    result.emplace_back(begin, begin + counts[i]);
  }
  return result;
}

}  // namespace fiber

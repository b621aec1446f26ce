#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace fiber {

/// Calls about items, the times of which are compared with those of others.
class TimedCalls {
 public:
  TimedCalls() = default;
  TimedCalls(const TimedCalls&) = delete;
  TimedCalls& operator=(const TimedCalls&) = delete;
  virtual ~TimedCalls() = default;

  virtual std::size_t size() const = 0;  ///< items

  /// Makes of the items what the calls work on. This is not measured.
  virtual void prepare() = 0;

  /// Asks about `count` items from `first` on. This is measured.
  virtual void call(std::size_t first, std::size_t count) = 0;

  /// These items are no more.
  virtual void leave_out(std::size_t first, std::size_t count) = 0;
};

struct TurnSizes {
  std::uint32_t repeats = 1;
  std::size_t block = 32;  ///< items that are asked about in a turn

  /// Calls that mostly take more than this are timed one by one, within their turn [ns].
  double slow_ns = std::numeric_limits<double>::infinity();
};

/// A block of items.
struct BlockTime {
  double item_ns = 0.0;  ///< per item, without the clock's own time; the median of the repeats
  std::size_t items = 0;
};

/// The times of all blocks of each. Blocks take turns with those of the others; who goes first
/// changes from repeat to repeat. Each is asked about once before it is timed, as the others have
/// filled the caches, unless it is a single item. Empty of calls without items.
///
/// All this is in a child process. Where calls end it, as some do that went well before, the items
/// of that turn are left out and all begin again. No other thread may be running.
std::vector<std::vector<BlockTime>> turn_times(const std::vector<TimedCalls*>& calls,
                                               const TurnSizes& sizes);

}  // namespace fiber

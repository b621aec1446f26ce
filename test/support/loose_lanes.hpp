#pragma once

#include <ucontext.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <type_traits>
#include <vector>

#include "src/cuda/device_of.hpp"
#include "src/cuda/host_executor.hpp"
#include "test/support/random.hpp"

namespace fiber::test {

/// The lanes of a few warps, each with a stack of its own, as the threads of a GPU have them: each
/// goes on by itself until it has to meet the others of its warp, in an order that is drawn. So a
/// kernel that reads what another lane has yet to write, or that has written already what it should
/// not have, gives another answer than HostWarp does, whose lanes meet after every step.
class LooseLanes {
 public:
  enum class Meeting { SYNC, BALLOT, VALUES };

  static constexpr std::size_t max_value_bytes = 64;
  struct Value {
    alignas(16) unsigned char bytes[max_value_bytes];
  };

  explicit LooseLanes(Random& random) : random_(random) {}

  /// @param body called with each warp's number, from 0 on, and lane
  void run(int warp_count, const std::function<void(int warp, int lane)>& body) {
    body_ = &body;
    lanes_ = std::vector<Lane>(static_cast<std::size_t>(warp_count * warp_width));
    warps_ = std::vector<Warp>(static_cast<std::size_t>(warp_count));
    std::vector<std::size_t> ready;
    for (std::size_t i = 0; i < lanes_.size(); ++i) {
      start(lanes_[i]);
      ready.push_back(i);
    }
    while (!ready.empty()) {
      std::swap(
          ready[static_cast<std::size_t>(random_.integer(0, static_cast<int>(ready.size()) - 1))],
          ready.back());
      current_ = ready.back();
      ready.pop_back();
      swapcontext(&scheduler_, &lanes_[current_].context);
      Warp& warp = warps_[current_ / warp_width];
      ++(lanes_[current_].has_ended ? warp.ended : warp.waiting);
      if (warp.waiting + warp.ended == warp_width && meet(current_ / warp_width)) {
        for (std::size_t lane = 0; lane < warp_width; ++lane) {
          ready.push_back(current_ / warp_width * warp_width + lane);
        }
      }
    }
  }

  /// Waits for the other lanes of its warp.
  /// @param value what they are to see of this one
  /// @return the values of all lanes, until the next meeting
  const Value* meet_others(Meeting meeting, const Value& value) {
    Lane& lane = lanes_[current_];
    const Value* const seen = warps_[current_ / warp_width].seen;
    lane.meeting = meeting;
    lane.value = value;
    swapcontext(&lane.context, &scheduler_);
    return seen;
  }

  /// How many warps had lanes that waited for others which did not come.
  int stuck_count() const { return stuck_count_; }

 private:
  static constexpr std::size_t stack_bytes = std::size_t{1} << 16U;

  struct Lane {
    ucontext_t context{};
    std::unique_ptr<char[]> stack;
    bool has_ended = false;
    Meeting meeting = Meeting::SYNC;
    Value value{};
  };
  struct Warp {
    int waiting = 0;
    int ended = 0;
    Value seen[warp_width];
  };

  void start(Lane& lane) {
    lane.stack = std::make_unique<char[]>(stack_bytes);
    getcontext(&lane.context);
    lane.context.uc_stack.ss_sp = lane.stack.get();
    lane.context.uc_stack.ss_size = stack_bytes;
    lane.context.uc_link = &scheduler_;
    running() = this;
    makecontext(&lane.context, &LooseLanes::run_lane, 0);
  }

  static LooseLanes*& running() {
    static thread_local LooseLanes* lanes = nullptr;
    return lanes;
  }

  static void run_lane() {
    LooseLanes& all = *running();
    const std::size_t own = all.current_;
    (*all.body_)(static_cast<int>(own / warp_width), static_cast<int>(own % warp_width));
    all.lanes_[own].has_ended = true;
  }

  /// @return whether the lanes of a warp go on: they all wait for the same
  bool meet(std::size_t number) {
    Warp& warp = warps_[number];
    if (warp.waiting == 0) {
      return false;
    }
    const Lane* const lanes = &lanes_[number * warp_width];
    const bool are_together =
        warp.ended == 0 && std::all_of(lanes, lanes + warp_width, [&](const Lane& lane) {
          return lane.meeting == lanes->meeting;
        });
    if (!are_together) {
      ++stuck_count_;
      return false;
    }
    std::transform(lanes, lanes + warp_width, warp.seen,
                   [](const Lane& lane) { return lane.value; });
    warp.waiting = 0;
    return true;
  }

  Random& random_;
  const std::function<void(int, int)>* body_ = nullptr;
  std::vector<Lane> lanes_;
  std::vector<Warp> warps_;
  std::size_t current_ = 0;
  ucontext_t scheduler_{};
  int stuck_count_ = 0;
};

/// A warp as one of these lanes sees it: the counterpart of DeviceWarp.
class LooseWarp {
 public:
  template <class T>
  class PerLane {
   public:
    T& operator[](int /*lane*/) { return value_; }
    const T& operator[](int /*lane*/) const { return value_; }

   private:
    T value_;
  };

 private:
  /// @return what tells the value of each lane
  template <class T>
  auto meet(LooseLanes::Meeting meeting, const T& value) const {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= LooseLanes::max_value_bytes);
    LooseLanes::Value own{};
    std::memcpy(own.bytes, &value, sizeof(T));
    const LooseLanes::Value* const all = lanes_.meet_others(meeting, own);
    return [all](int lane) {
      T result;
      std::memcpy(&result, all[lane].bytes, sizeof(T));
      return result;
    };
  }

 public:
  LooseWarp(LooseLanes& lanes, int lane) : lanes_(lanes), lane_(lane) {}

  template <class Call>
  void each(const Call& call) const {
    call(lane_);
  }
  template <class Predicate>
  std::uint32_t ballot(const Predicate& predicate) const {
    const auto votes = meet<std::uint32_t>(LooseLanes::Meeting::BALLOT, predicate(lane_) ? 1U : 0U);
    std::uint32_t bits = 0;
    for (int lane = 0; lane < warp_width; ++lane) {
      bits |= votes(lane) << lane;
    }
    return bits;
  }
  template <class T>
  T from(const PerLane<T>& values, int lane) const {
    return meet<T>(LooseLanes::Meeting::VALUES, values[0])(lane);
  }
  template <class T, class Join>
  T reduce(const PerLane<T>& values, const Join& join) const {
    const auto all = meet<T>(LooseLanes::Meeting::VALUES, values[0]);
    T joined = all(0);
    for (int lane = 1; lane < warp_width; ++lane) {
      join(joined, all(lane));
    }
    return joined;
  }
  std::uint64_t raise(std::uint64_t* counter, std::uint64_t by) const {
    PerLane<std::uint64_t> before;
    before[0] = lane_ == 0 ? __atomic_fetch_add(counter, by, __ATOMIC_RELAXED) : 0;
    return from(before, 0);
  }
  void sync() const { meet<std::uint32_t>(LooseLanes::Meeting::SYNC, 0); }

 private:
  LooseLanes& lanes_;
  int lane_;
};

/// Runs a few warps at a time so, on the caller's thread.
class LooseExecutor : public HostExecutor<HeapMemory> {
 public:
  explicit LooseExecutor(Random& random) : random_(random), lanes_(random) {}

  template <class Call>
  void for_each_warp(std::uint32_t count, const Call& call) {
    for (std::uint32_t first = 0; first < count;) {
      const auto at_once =
          std::min(count - first, static_cast<std::uint32_t>(random_.integer(1, 8)));
      std::vector<typename Call::Scratch> scratch(at_once);
      constexpr int rubbish = 0xA5;
      std::memset(static_cast<void*>(scratch.data()), rubbish,
                  scratch.size() * sizeof(typename Call::Scratch));
      lanes_.run(static_cast<int>(at_once), [&](int warp, int lane) {
        const auto own = static_cast<std::uint32_t>(warp);
        call(LooseWarp(lanes_, lane), first + own, scratch[own]);
      });
      first += at_once;
    }
  }

  int stuck_count() const { return lanes_.stuck_count(); }

 private:
  Random& random_;
  LooseLanes lanes_;
};

}  // namespace fiber::test

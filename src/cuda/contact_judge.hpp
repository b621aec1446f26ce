#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "src/cuda/contact_room.hpp"
#include "src/cuda/device.hpp"
#include "src/cuda/judge_pairs.hpp"

namespace fiber {

/// Decides which pairs are contacts, and brings these together, on the device; to the host they go
/// in parts, each while the device decides about the next.
template <class Executor>
class ContactJudge {
 public:
  using Room = ContactRoom<Executor::template Buffer>;
  using HostRoom = ContactRoom<Executor::template HostBuffer>;

  /// @param pairs sorted, on the device
  DeviceContacts judge_on_device(Executor& executor, const TreePoints& points, double margin,
                                 const std::uint64_t* pairs, std::uint32_t count) {
    begin(points, margin, pairs, count, count);
    for (std::uint32_t part = 0; part < part_count_; ++part) {
      start(executor, part);
    }
    const std::uint32_t found = finish(executor);
    return {found, device_->arrays(), nullptr, device_.hold()};
  }

  /// The same in page-locked memory of the host, once wait() has returned.
  DeviceContacts judge_to_host(Executor& executor, const TreePoints& points, double margin,
                               const std::uint64_t* pairs, std::uint32_t count) {
    host_.leave_what_is_held();
    begin(points, margin, pairs, count,
          std::max(Executor::min_judged_at_once, count / max_parts + 1));
    std::uint32_t sent = 0;
    for (std::uint32_t part = 0; part < part_count_; ++part) {
      if (part == 0) {
        start(executor, part);
      }
      if (part + 1 < part_count_) {
        start(executor, part + 1);
      }
      const std::uint32_t found = total(part);
      if (found <= std::min(device_->capacity(), host_->capacity())) {
        send(executor, sent, found);
        sent = found;
      }
    }
    const std::uint32_t found = finish(executor);
    if (found > host_->capacity()) {
      executor.wait_for_sent();
      host_->resize(found);
      sent = 0;
    }
    send(executor, sent, found);
    return {found, host_->arrays(), nullptr, host_.hold()};
  }
  /// The last contacts.
  Room& on_device() { return *device_; }
  HostRoom& on_host() { return *host_; }
  void wait(Executor& executor) { executor.wait_for_sent(); }

  std::size_t memory_bytes() const { return judged_.bytes() + places_.bytes() + device_.bytes(); }

 private:
  // Each costs the device a few launches; the first is waited for.
  static constexpr std::uint32_t max_parts = 8;

  void begin(const TreePoints& points, double margin, const std::uint64_t* pairs,
             std::uint32_t count, std::uint32_t part_size) {
    device_.leave_what_is_held();
    judge_ = {points, margin, pairs, nullptr, nullptr, 0};
    count_ = count;
    part_size_ = part_size;
    part_count_ = count == 0 ? 0 : (count - 1) / part_size + 1;
    judged_.resize(count);
    places_.resize(count);
    totals_.resize(max_parts);
    judge_.judged = judged_.data();
    judge_.are_contacts = places_.data();
  }

  std::uint32_t part_begin(std::uint32_t part) const { return part * part_size_; }
  std::uint32_t part_end(std::uint32_t part) const {
    return part + 1 < part_count_ ? part_begin(part + 1) : count_;
  }

  void start(Executor& executor, std::uint32_t part) {
    const std::uint32_t begin = part_begin(part);
    const std::uint32_t end = part_end(part);
    judge_.first = begin;
    executor.for_each(end - begin, judge_);
    // From the last of the part before on, where the sum up to there stands.
    const std::uint32_t from = begin == 0 ? 0 : begin - 1;
    executor.add_up(places_, from, end - from);
    write(executor, begin, end, totals_.data() + part);
    marks_[part].set(executor);
  }

  void write(Executor& executor, std::uint32_t begin, std::uint32_t end, std::uint32_t* total) {
    executor.for_each(end - begin,
                      WriteContacts{judge_.pairs, judged_.data(), places_.data(), begin, end,
                                    device_->arrays(), device_->capacity(), total});
  }

  /// How many contacts come up to and with this part, once they are written.
  std::uint32_t total(std::uint32_t part) {
    marks_[part].wait();
    return totals_.data()[part];
  }

  /// @return how many contacts there are, which are all on the device when it returns
  std::uint32_t finish(Executor& executor) {
    const std::uint32_t found = part_count_ == 0 ? 0 : total(part_count_ - 1);
    if (found > device_->capacity()) {
      // Parts that there was room for may be on their way still.
      executor.wait_for_sent();
      device_->resize(found);
      write(executor, 0, count_, totals_.data());
      marks_[0].set(executor);
      marks_[0].wait();
    }
    return found;
  }

  void send(Executor& executor, std::uint32_t begin, std::uint32_t end) {
    const std::size_t count = end - begin;
    if (count == 0) {
      return;
    }
    executor.send(device_->a, begin, count, host_->a);
    executor.send(device_->b, begin, count, host_->b);
    executor.send(device_->s, begin, count, host_->s);
    executor.send(device_->t, begin, count, host_->t);
    executor.send(device_->distance, begin, count, host_->distance);
  }

  JudgePairs judge_{};
  std::uint32_t count_ = 0;
  std::uint32_t part_size_ = 0;
  std::uint32_t part_count_ = 0;
  typename Executor::template Buffer<JudgedPair> judged_;
  typename Executor::template Buffer<std::uint32_t> places_;
  HeldRoom<Executor::template Buffer> device_;
  HeldRoom<Executor::template HostBuffer> host_;
  typename Executor::template HostBuffer<std::uint32_t> totals_;
  typename Executor::Mark marks_[max_parts];
};

}  // namespace fiber

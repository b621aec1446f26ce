#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "src/cuda/contact_judge.hpp"
#include "src/cuda/device.hpp"
#include "src/cuda/device_tree_of.hpp"

namespace fiber {

/// A device of an executor, which DeviceTreeOf tells of.
template <class Executor>
class DeviceOf final : public Device {
 public:
  explicit DeviceOf(std::shared_ptr<Executor> executor) : executor_(std::move(executor)) {}

  std::unique_ptr<DeviceTree> make_tree() override {
    return std::make_unique<DeviceTreeOf<Executor>>(executor_);
  }

  std::uint64_t find(const DeviceTree& a, std::uint32_t first_leaf, std::uint32_t leaf_count,
                     const DeviceTree& b, const PairRule& rule, std::uint64_t most,
                     std::vector<std::uint64_t>& keys) override {
    keys.clear();
    clock_.start(*executor_);
    const std::uint64_t count = search(a, first_leaf, leaf_count, b, rule, most);
    clock_.stop(*executor_);
    if (count <= most) {
      keys.resize(static_cast<std::size_t>(count));
      executor_->download(pairs_, 0, keys.size(), keys.data());
    }
    return count;
  }

  DeviceContacts contacts(const DeviceTree& tree, const PairRule& rule, double margin) override {
    clock_.start(*executor_);
    const std::uint32_t count = search_for_contacts(tree, rule);
    // They are there when it returns: others may read them.
    const DeviceContacts contacts =
        judge_.judge_on_device(*executor_, tree.points(), margin, pairs_.data(), count);
    clock_.stop(*executor_);
    return contacts;
  }

  DeviceContacts contacts_to_host(const DeviceTree& tree, const PairRule& rule,
                                  double margin) override {
    clock_.start(*executor_);
    const std::uint32_t count = search_for_contacts(tree, rule);
    const DeviceContacts contacts =
        judge_.judge_to_host(*executor_, tree.points(), margin, pairs_.data(), count);
    clock_.stop(*executor_);
    judge_.wait(*executor_);
    return contacts;
  }

  std::shared_ptr<void> lock_pages(const void* data, std::size_t bytes) override {
    return executor_->lock_pages(data, bytes);
  }

  std::shared_ptr<void> make_array(const void* from, std::size_t bytes) override {
    auto array = std::make_shared<typename Executor::template Buffer<char>>();
    executor_->upload(static_cast<const char*>(from), bytes, *array);
    clock_.start(*executor_);
    clock_.stop(*executor_);
    clock_.seconds();
    return {array, array->data()};
  }
  void read(const void* from, std::size_t bytes, void* to) override {
    executor_->download_from(static_cast<const char*>(from), bytes, static_cast<char*>(to));
  }

  std::size_t memory_bytes() const override {
    return pairs_.bytes() + count_.bytes() + judge_.memory_bytes();
  }
  double seconds() const override { return clock_.seconds(); }

 private:
  static constexpr std::uint64_t first_room = 1024;

  /// The pairs, sorted, in pairs_; none if there are more than `most`.
  std::uint64_t search(const DeviceTree& a, std::uint32_t first_leaf, std::uint32_t leaf_count,
                       const DeviceTree& b, const PairRule& rule, std::uint64_t most) {
    if (leaf_count == 0 || b.view().level_count == 0) {
      return 0;
    }
    count_.resize(1);
    if (pairs_.size() == 0) {
      pairs_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(most, first_room)));
    }
    for (;;) {
      executor_->zero(count_);
      executor_->for_each_warp(leaf_count,
                               FindPairs{a.view(), b.view(), rule, a.fibers_by_point(), first_leaf,
                                         pairs_.data(), pairs_.size(), count_.data()});
      std::uint64_t count = 0;
      executor_->download(count_, 0, 1, &count);
      if (count > most) {
        return count;
      }
      if (count <= pairs_.size()) {
        executor_->sort(pairs_, static_cast<std::size_t>(count), bits_of_points(a, b));
        return count;
      }
      // Room for a few more, as the next frame may have: looking twice takes longer.
      constexpr std::uint64_t a_part = 8;
      pairs_.resize(static_cast<std::size_t>(std::min(most, count + count / a_part)));
    }
  }

  /// How many pairs of a tree's segments with each other are near; sorted, in pairs_.
  std::uint32_t search_for_contacts(const DeviceTree& tree, const PairRule& rule) {
    constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
    const std::uint64_t found = search(tree, 0, tree.view().leaf_count(), tree, rule, most);
    if (found > most) {
      throw std::runtime_error("cuda_tree: " + std::to_string(found) +
                               " pairs are near, more than the 2^32 that contacts may be of");
    }
    return static_cast<std::uint32_t>(found);
  }

  /// How many bits the numbers of points of both have.
  static int bits_of_points(const DeviceTree& a, const DeviceTree& b) {
    int bits = 1;
    while (std::max(a.point_count(), b.point_count()) >> bits != 0) {
      ++bits;
    }
    return bits;
  }

  std::shared_ptr<Executor> executor_;
  typename Executor::template Buffer<std::uint64_t> pairs_;
  typename Executor::template Buffer<std::uint64_t> count_;
  ContactJudge<Executor> judge_;
  typename Executor::Clock clock_;
};

}  // namespace fiber

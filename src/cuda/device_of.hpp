#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "src/cuda/contact_judge.hpp"
#include "src/cuda/device.hpp"
#include "src/cuda/device_tree_of.hpp"
#include "src/cuda/mark_touching.hpp"
#include "src/cuda/write_pairs.hpp"

namespace fiber {

/// A device of an executor, which DeviceTreeOf tells of.
template <class Executor>
class DeviceOf final : public Device {
 public:
  explicit DeviceOf(std::shared_ptr<Executor> executor) : executor_(std::move(executor)) {}

  std::unique_ptr<DeviceTree> make_tree() override {
    const Turn turn(*executor_);
    return std::make_unique<DeviceTreeOf<Executor>>(executor_);
  }

  std::uint64_t find(const DeviceTree& a, std::uint32_t first_leaf, std::uint32_t leaf_count,
                     const DeviceTree& b, const PairRule& rule, std::uint64_t most,
                     std::vector<std::uint64_t>& keys) override {
    const Turn turn(*executor_);
    keys.clear();
    clock_.start(*executor_);
    const std::uint64_t count = search(a, first_leaf, leaf_count, b, rule, most);
    if (count <= most) {
      keys.resize(static_cast<std::size_t>(count));
      executor_->download(pairs_, 0, keys.size(), keys.data());
    }
    return count;
  }

  DeviceContacts contacts(const DeviceTree& tree, const PairRule& rule, double margin) override {
    const Turn turn(*executor_);
    const std::uint32_t count = search_for_contacts(tree, rule);
    // They are there when it returns: others may read them.
    DeviceContacts contacts =
        judge_.judge_on_device(*executor_, tree.points(), margin, pairs_.data(), count);
    if (find_candidates(tree, contacts.count)) {
      contacts.candidate_begins = judge_.on_device().candidate_begins.data();
      found_.set(*executor_);
      found_.wait();
    }
    clock_.end(*executor_, "contacts");
    return contacts;
  }

  DeviceContacts contacts_to_host(const DeviceTree& tree, const PairRule& rule,
                                  double margin) override {
    const Turn turn(*executor_);
    const std::uint32_t count = search_for_contacts(tree, rule);
    DeviceContacts contacts =
        judge_.judge_to_host(*executor_, tree.points(), margin, pairs_.data(), count);
    const bool has_candidates = find_candidates(tree, contacts.count);
    clock_.end(*executor_, "contacts");
    if (has_candidates) {
      const auto& begins = judge_.on_device().candidate_begins;
      auto& on_host = judge_.on_host().candidate_begins;
      on_host.resize(begins.size());
      executor_->download(begins, 0, begins.size(), on_host.data());
      contacts.candidate_begins = on_host.data();
    }
    judge_.wait(*executor_);
    return contacts;
  }

  void touching(const DeviceTree& tree, const PairRule& rule, double margin, bool needs_loops,
                std::vector<std::uint32_t>& touching, std::vector<std::uint64_t>& asked) override {
    const Turn turn(*executor_);
    const CandidateView& candidates = tree.candidates();
    touching.assign(candidates.count, 0);
    asked.clear();
    clock_.start(*executor_);
    if (leaf_count(tree) == 0) {
      return;
    }
    touching_.resize(candidates.count);
    executor_->zero(touching_);
    const std::uint64_t found =
        find_with(tree, 0, leaf_count(tree), tree, rule, max_pairs, [&](const WritePairs& pairs) {
          return MarkTouching{tree.points(), margin,      tree.fibers_by_point(),
                              candidates,    needs_loops, touching_.data(),
                              pairs};
        });
    clock_.end(*executor_, "pairs");
    require_pairs(found);
    executor_->download(touching_, 0, touching.size(), touching.data());
    asked.resize(static_cast<std::size_t>(found));
    executor_->download(pairs_, 0, asked.size(), asked.data());
  }

  void read_points(const DeviceTree& tree, const std::vector<std::uint32_t>& points,
                   double* to) override {
    const Turn turn(*executor_);
    if (points.empty()) {
      return;
    }
    typename Executor::template Buffer<std::uint32_t> wanted;
    typename Executor::template Buffer<double> gathered;
    executor_->upload(points.data(), points.size(), wanted);
    gathered.resize(3 * points.size());
    executor_->for_each(static_cast<std::uint32_t>(points.size()),
                        GatherPoints{tree.points().coordinates, wanted.data(), gathered.data()});
    executor_->download(gathered, 0, gathered.size(), to);
  }

  std::shared_ptr<void> lock_pages(const void* data, std::size_t bytes) override {
    const Turn turn(*executor_);
    return executor_->lock_pages(data, bytes);
  }

  std::shared_ptr<void> make_array(const void* from, std::size_t bytes) override {
    const Turn turn(*executor_);
    auto array = std::make_shared<typename Executor::template Buffer<char>>();
    executor_->upload(static_cast<const char*>(from), bytes, *array);
    found_.set(*executor_);
    found_.wait();
    return {array, array->data()};
  }
  void read(const void* from, std::size_t bytes, void* to) override {
    const Turn turn(*executor_);
    executor_->download_from(static_cast<const char*>(from), bytes, static_cast<char*>(to));
  }

  std::optional<int> gpu() const override { return executor_->gpu(); }

  std::size_t memory_bytes() const override {
    return pairs_.bytes() + count_.bytes() + touching_.bytes() + judge_.memory_bytes() +
           executor_->memory_bytes();
  }
  std::vector<DeviceStage> stages() const override { return clock_.stages(); }

 private:
  using Turn = typename Executor::Turn;

  static constexpr std::uint64_t first_room = 1024;
  static constexpr std::uint64_t max_pairs = Executor::max_values;

  /// The pairs, sorted, in pairs_; none if there are more than `most`.
  std::uint64_t search(const DeviceTree& a, std::uint32_t first_leaf, std::uint32_t leaf_count,
                       const DeviceTree& b, const PairRule& rule, std::uint64_t most) {
    if (leaf_count == 0 || b.view().level_count == 0) {
      return 0;
    }
    const std::uint64_t count = find_with(a, first_leaf, leaf_count, b, rule, most,
                                          [](const WritePairs& pairs) { return pairs; });
    clock_.end(*executor_, "pairs");
    if (count <= most) {
      executor_->sort(pairs_, static_cast<std::size_t>(count), bits_of_points(a, b));
      clock_.end(*executor_, "order of pairs");
    }
    return count;
  }

  /// Has the pairs written down, in any order, in pairs_; those of them that there is room for if
  /// there are more than `most`.
  /// @param taker_of what takes the pairs where it is given a WritePairs; it is asked anew when
  ///                 there was too little room
  template <class TakerOf>
  std::uint64_t find_with(const DeviceTree& a, std::uint32_t first_leaf, std::uint32_t leaf_count,
                          const DeviceTree& b, const PairRule& rule, std::uint64_t most,
                          const TakerOf& taker_of) {
    using Taker = decltype(taker_of(WritePairs()));
    count_.resize(1);
    if (pairs_.size() == 0) {
      pairs_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(most, first_room)));
    }
    for (;;) {
      executor_->zero(count_);
      executor_->for_each_warp(
          leaf_count,
          FindPairs<Taker>{a.view(), b.view(), rule, a.fibers_by_point(), a.candidates(),
                           first_leaf, taker_of({pairs_.data(), pairs_.size(), count_.data()})});
      std::uint64_t count = 0;
      executor_->download(count_, 0, 1, &count);
      if (count > most || count <= pairs_.size()) {
        return count;
      }
      // Room for a few more, as the next frame may have: looking twice takes longer.
      constexpr std::uint64_t a_part = 8;
      pairs_.resize(static_cast<std::size_t>(std::min(most, count + count / a_part)));
    }
  }

  /// How many pairs of a tree's segments with each other are near; sorted, in pairs_.
  std::uint32_t search_for_contacts(const DeviceTree& tree, const PairRule& rule) {
    // Contacts that somebody has let go of may still be read by what he has given the device.
    executor_->wait_for_others();
    clock_.start(*executor_);
    const std::uint64_t found = search(tree, 0, leaf_count(tree), tree, rule, max_pairs);
    require_pairs(found);
    return static_cast<std::uint32_t>(found);
  }

  static void require_pairs(std::uint64_t found) {
    if (found > max_pairs) {
      throw std::runtime_error("cuda_tree: " + std::to_string(found) +
                               " pairs are near, contacts may be of at most " +
                               std::to_string(max_pairs));
    }
  }

  /// How many leaves have pairs to look for: what stands still has none of its own.
  static std::uint32_t leaf_count(const DeviceTree& tree) {
    const CandidateView& candidates = tree.candidates();
    return candidates.exist() && tree.view().level_count > 0
               ? (candidates.segment_end + warp_width - 1) / warp_width
               : tree.view().leaf_count();
  }

  /// Which of the contacts that have been found are of which candidate.
  /// @return whether there are candidates
  bool find_candidates(const DeviceTree& tree, std::uint32_t contact_count) {
    const CandidateView& candidates = tree.candidates();
    if (!candidates.exist()) {
      return false;
    }
    auto& contacts = judge_.on_device();
    contacts.candidate_begins.resize(candidates.count + 1);
    executor_->for_each(candidates.count + 1,
                        FindCandidates{candidates, contacts.a.data(), contact_count,
                                       contacts.candidate_begins.data()});
    return true;
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
  typename Executor::template Buffer<std::uint32_t> touching_;
  ContactJudge<Executor> judge_;
  typename Executor::Mark found_;
  typename Executor::Clock clock_;
};

}  // namespace fiber

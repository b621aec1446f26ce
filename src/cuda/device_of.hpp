#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/cuda/device.hpp"

namespace fiber {

/// What executors have, whose calls take effect in their order:
///
/// - Buffer<T>, device memory: resize(count) makes it as long, without what was in it; data(),
/// size(),
///   bytes()
/// - upload(from, count, buffer), download(buffer, first, count, to), download_from(pointer, count,
///   to), zero(buffer)
/// - require_own(pointer), which throws std::invalid_argument where the device cannot read, and
///   wait_for_others(), until what others have given the device is done
/// - for_each(count, f), which calls f(index) for 0 … count − 1, and for_each_warp(count, f), which
///   calls f(warp, index, scratch), with an F::Scratch that a warp shares
/// - sort_by_key(keys, values, count, bits), ascending, of keys of so many bits; sort(keys, count,
///   bits), of keys whose halves have so many; add_up(buffer, count) makes each the sum of all up
///   to it
/// - Clock: start(), stop(), and seconds() between the two of what the device has done
template <class Executor>
class DeviceTreeOf final : public DeviceTree {
 public:
  explicit DeviceTreeOf(std::shared_ptr<Executor> executor) : executor_(std::move(executor)) {}

  void set_topology(const HostTopology& topology) override {
    segment_count_ = static_cast<std::uint32_t>(topology.first_points.size());
    executor_->upload(topology.first_points.data(), topology.first_points.size(), first_points_);
    executor_->upload(topology.fibers.data(), topology.fibers.size(), fibers_);
  }

  void update(const HostFibers& fibers) override {
    view_ = {};
    if (segment_count_ == 0) {
      return;
    }
    executor_->upload(fibers.coordinates, 3 * fibers.point_count, coordinates_);
    clock_.start(*executor_);
    build(fibers);
    clock_.stop(*executor_);
  }

  void update(const HostFibers& fibers, const double* coordinates) override {
    update_from(fibers, coordinates);
  }
  void update(const HostFibers& fibers, const float* coordinates) override {
    update_from(fibers, coordinates);
  }

  double seconds() const override { return clock_.seconds(); }

  const SegmentTreeView& view() const override { return view_; }
  const std::uint32_t* fibers_by_point() const override { return fibers_.data(); }
  std::size_t point_count() const override { return fibers_.size(); }
  const TreePoints& points() const override { return points_; }

  std::size_t memory_bytes() const override {
    std::size_t bytes = first_points_.bytes() + fibers_.bytes() + coordinates_.bytes() +
                        radii_.bytes() + bounds_.bytes() + keys_.bytes() + order_.bytes() +
                        segments_.bytes();
    for (const auto& boxes : boxes_) {
      bytes += boxes.bytes();
    }
    return bytes;
  }

 private:
  static std::uint32_t in_warps(std::uint32_t count) {
    return (count + warp_width - 1) / warp_width;
  }

  template <class Number>
  void update_from(const HostFibers& fibers, const Number* coordinates) {
    view_ = {};
    if (segment_count_ == 0) {
      return;
    }
    executor_->require_own(coordinates);
    executor_->wait_for_others();
    const auto count = static_cast<std::uint32_t>(3 * fibers.point_count);
    coordinates_.resize(count);
    bad_count_.resize(1);
    clock_.start(*executor_);
    executor_->zero(bad_count_);
    executor_->for_each_warp(
        in_warps(count),
        TakePoints<Number>{coordinates, count, coordinates_.data(), bad_count_.data()});
    build(fibers);
    clock_.stop(*executor_);
    std::uint64_t bad_count = 0;
    executor_->download(bad_count_, 0, 1, &bad_count);
    if (bad_count != 0) {
      view_ = {};
      throw std::invalid_argument(
          std::to_string(bad_count) +
          " coordinates on the device are not finite, or above 1e150 m in magnitude");
    }
  }

  /// Of the coordinates that are there.
  void build(const HostFibers& fibers) {
    if (fibers.radii != nullptr) {
      executor_->upload(fibers.radii, fibers.point_count, radii_);
    }
    points_.coordinates = coordinates_.data();
    points_.first_points = first_points_.data();
    points_.segment_count = segment_count_;
    points_.point_count = static_cast<std::uint32_t>(fibers.point_count);
    points_.radii = fibers.radii != nullptr ? radii_.data() : nullptr;
    points_.radius = fibers.radius;
    std::copy(fibers.origin, fibers.origin + 3, points_.origin);
    sort(points_);
    fit(points_);
  }

  /// Brings the segments into the order of the curve.
  void sort(const TreePoints& points) {
    std::uint32_t count =
        (points.point_count + BoundPoints::points_each - 1) / BoundPoints::points_each;
    // The last of them, of all, stands at the end.
    std::uint32_t all = count;
    for (std::uint32_t level = count; level > 1; level = in_warps(level)) {
      all += in_warps(level);
    }
    bounds_.resize(all);
    PointBounds* bounds = bounds_.data();
    executor_->for_each_warp(count, BoundPoints{points, bounds});
    while (count > 1) {
      executor_->for_each_warp(in_warps(count),
                               JoinBoxes<PointBounds>{bounds, count, bounds + count});
      bounds += count;
      count = in_warps(count);
    }
    keys_.resize(segment_count_);
    order_.resize(segment_count_);
    executor_->for_each(segment_count_, PlaceSegments{points, bounds, keys_.data(), order_.data()});
    executor_->sort_by_key(keys_, order_, segment_count_, 3 * PlaceSegments::bits);
  }

  /// Fits the boxes to them.
  void fit(const TreePoints& points) {
    segments_.resize(segment_count_);
    executor_->for_each(segment_count_, ReadSegments{points, order_.data(), segments_.data()});
    view_.segments = segments_.data();
    view_.segment_count = segment_count_;
    std::uint32_t count = in_warps(segment_count_);
    for (int level = 0;; ++level) {
      boxes_[level].resize(count);
      TreeBox* const boxes = boxes_[level].data();
      if (level == 0) {
        executor_->for_each_warp(count, FitLeaves{segments_.data(), segment_count_, boxes});
      } else {
        executor_->for_each_warp(
            count, JoinBoxes<TreeBox>{view_.boxes[level - 1], view_.box_counts[level - 1], boxes});
      }
      view_.boxes[level] = boxes;
      view_.box_counts[level] = count;
      view_.level_count = level + 1;
      if (count <= warp_width) {
        return;
      }
      count = in_warps(count);
    }
  }

  template <class T>
  using Buffer = typename Executor::template Buffer<T>;

  std::shared_ptr<Executor> executor_;
  std::uint32_t segment_count_ = 0;
  Buffer<std::uint32_t> first_points_;
  Buffer<std::uint32_t> fibers_;
  Buffer<double> coordinates_;
  Buffer<double> radii_;
  Buffer<PointBounds> bounds_;
  Buffer<std::uint32_t> keys_;
  Buffer<std::uint32_t> order_;
  Buffer<TreeSegment> segments_;
  Buffer<TreeBox> boxes_[SegmentTreeView::max_levels];
  Buffer<std::uint64_t> bad_count_;
  TreePoints points_;
  SegmentTreeView view_;
  typename Executor::Clock clock_;
};

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
    constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
    clock_.start(*executor_);
    const std::uint64_t found = search(tree, 0, tree.view().leaf_count(), tree, rule, most);
    if (found > most) {
      throw std::runtime_error("cuda_tree: " + std::to_string(found) +
                               " pairs are near, more than the 2^32 that contacts may be of");
    }
    const auto count = static_cast<std::uint32_t>(found);
    DeviceContacts contacts;
    if (count > 0) {
      judged_.resize(count);
      places_.resize(count);
      executor_->for_each(
          count, JudgePairs{tree.points(), margin, pairs_.data(), judged_.data(), places_.data()});
      executor_->add_up(places_, count);
      executor_->download(places_, count - 1, 1, &contacts.count);
      contacts.arrays = make_arrays(contacts.count);
      executor_->for_each(
          count, WriteContacts{pairs_.data(), judged_.data(), places_.data(), contacts.arrays});
    }
    clock_.stop(*executor_);
    clock_.seconds();  // until it has all been done: others may read it
    return contacts;
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
    return pairs_.bytes() + count_.bytes() + judged_.bytes() + places_.bytes() + a_.bytes() +
           b_.bytes() + s_.bytes() + t_.bytes() + distance_.bytes();
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

  ContactArrays make_arrays(std::uint32_t count) {
    a_.resize(count);
    b_.resize(count);
    s_.resize(count);
    t_.resize(count);
    distance_.resize(count);
    return {a_.data(), b_.data(), s_.data(), t_.data(), distance_.data()};
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
  typename Executor::template Buffer<JudgedPair> judged_;
  typename Executor::template Buffer<std::uint32_t> places_;
  typename Executor::template Buffer<std::uint32_t> a_;
  typename Executor::template Buffer<std::uint32_t> b_;
  typename Executor::template Buffer<double> s_;
  typename Executor::template Buffer<double> t_;
  typename Executor::template Buffer<double> distance_;
  typename Executor::Clock clock_;
};

}  // namespace fiber

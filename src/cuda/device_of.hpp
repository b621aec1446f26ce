#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "src/cuda/device.hpp"

namespace fiber {

/// What executors have:
///   Buffer<T>   device memory: resize(count) makes it as long, without what was in it; data(),
///   size() upload(from, count, buffer), download(buffer, count, to) for_each(count, f) calls
///   f(index) for 0 … count − 1 for_each_warp(count, f)   calls f(warp, index, scratch), with an
///   F::Scratch that a warp shares sort_by_key(keys, values, count, bits), sort(keys, count)
///   ascending; keys of so many bits zero(buffer)
/// Calls take effect in their order.
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
    if (fibers.radii != nullptr) {
      executor_->upload(fibers.radii, fibers.point_count, radii_);
    }
    TreePoints points;
    points.coordinates = coordinates_.data();
    points.first_points = first_points_.data();
    points.segment_count = segment_count_;
    points.point_count = static_cast<std::uint32_t>(fibers.point_count);
    points.radii = fibers.radii != nullptr ? radii_.data() : nullptr;
    points.radius = fibers.radius;
    std::copy(fibers.origin, fibers.origin + 3, points.origin);
    sort(points);
    fit(points);
  }

  const SegmentTreeView& view() const override { return view_; }
  const std::uint32_t* fibers_by_point() const override { return fibers_.data(); }
  std::size_t point_count() const override { return fibers_.size(); }

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
  SegmentTreeView view_;
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
      executor_->download(count_, 1, &count);
      if (count > most) {
        return count;
      }
      if (count <= pairs_.size()) {
        executor_->sort(pairs_, static_cast<std::size_t>(count), bits_of_points(a, b));
        keys.resize(static_cast<std::size_t>(count));
        executor_->download(pairs_, keys.size(), keys.data());
        return count;
      }
      // Room for a few more, as the next frame may have: looking twice takes longer.
      constexpr std::uint64_t a_part = 8;
      pairs_.resize(static_cast<std::size_t>(std::min(most, count + count / a_part)));
    }
  }

  std::size_t memory_bytes() const override { return pairs_.bytes() + count_.bytes(); }

 private:
  static constexpr std::uint64_t first_room = 1024;

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
};

}  // namespace fiber

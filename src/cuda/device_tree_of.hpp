#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "src/cuda/device.hpp"

namespace fiber {

/// The interface of executors, whose calls take effect in their order:
///
/// - Turn, which makes the device that of the calling thread for as long as it lives: all else is
///   called within one
/// - Buffer<T>, memory of the device, and HostBuffer<T>, that of the host which kernels write, too:
///   DeviceBuffer has what they can
/// - upload(from, count, buffer), upload_in_place(from, count, buffer), which may read until the
///   next download() has returned, download(buffer, first, count, to), download_from(pointer,
///   count, to), zero(buffer)
/// - send(buffer, first, count, host_buffer), which goes on while kernels work, until
///   wait_for_sent(): what is sent must be there already
/// - lock_pages(data, bytes), for as long as the result is held
/// - gpu(), which of them it is, if any
/// - require_own(pointer), which throws std::invalid_argument where the device cannot read, and
///   wait_for_others(), until what others have given the device is done
/// - for_each(count, f), which calls f(index) for 0 … count − 1, and for_each_warp(count, f), which
///   calls f(warp, index, scratch), with an F::Scratch that a warp shares
/// - sort_by_key(keys, values, count, bits), ascending, of keys of so many bits; sort(keys, count,
///   bits), of keys whose halves have so many; add_up(buffer, first, count) makes each of these the
///   sum of all from the first of them up to it
/// - Mark: set(), and wait() until what came before is done
/// - Clock: start(), end(executor, name) of each stage, and stages() since the last start(), of
/// what
///   the device has done
/// - min_judged_at_once, pairs that are worth a part of their own where contacts go to the host
/// - max_values that it sorts and adds up; memory_bytes() that this takes
template <class Executor>
class DeviceTreeOf final : public DeviceTree {
 public:
  explicit DeviceTreeOf(std::shared_ptr<Executor> executor) : executor_(std::move(executor)) {}

  void set_topology(const HostTopology& topology) override {
    const Turn turn(*executor_);
    segment_count_ = static_cast<std::uint32_t>(topology.first_points.size());
    executor_->upload(topology.first_points.data(), topology.first_points.size(), first_points_);
    executor_->upload(topology.fibers.data(), topology.fibers.size(), fibers_);
    candidates_ = {};
    if (!topology.candidate_points.empty()) {
      take_candidates(topology);
    }
  }

  void update(const HostFibers& fibers) override {
    const Turn turn(*executor_);
    view_ = {};
    if (segment_count_ == 0) {
      return;
    }
    std::uint64_t bad_count = 0;
    try {
      executor_->upload_in_place(fibers.coordinates, 3 * fibers.point_count, coordinates_);
      clock_.start(*executor_);
      bad_count = build(fibers);
    } catch (...) {
      executor_->wait_for_others();  // the device may still read the points
      throw;
    }
    if (bad_count != 0) {
      refuse_points(fibers);
    }
  }

  void update(const HostFibers& fibers, const double* coordinates) override {
    update_from(fibers, coordinates);
  }
  void update(const HostFibers& fibers, const float* coordinates) override {
    update_from(fibers, coordinates);
  }

  std::vector<DeviceStage> stages() const override { return clock_.stages(); }

  const SegmentTreeView& view() const override { return view_; }
  const std::uint32_t* fibers_by_point() const override { return fibers_.data(); }
  std::size_t point_count() const override { return fibers_.size(); }
  const CandidateView& candidates() const override { return candidates_; }
  const TreePoints& points() const override { return points_; }

  std::size_t memory_bytes() const override {
    std::size_t bytes = first_points_.bytes() + fibers_.bytes() + coordinates_.bytes() +
                        radii_.bytes() + bounds_.bytes() + bad_count_.bytes() + keys_.bytes() +
                        order_.bytes() + segments_.bytes() + candidates_of_fibers_.bytes() +
                        candidate_points_.bytes() + candidate_segments_.bytes();
    for (const auto& boxes : boxes_) {
      bytes += boxes.bytes();
    }
    return bytes;
  }

 private:
  using Turn = typename Executor::Turn;

  static std::uint32_t in_warps(std::uint32_t count) {
    return (count + warp_width - 1) / warp_width;
  }

  void take_candidates(const HostTopology& topology) {
    const auto upload = [&](const std::vector<std::uint32_t>& from, auto& to) {
      executor_->upload(from.data(), from.size(), to);
      return to.data();
    };
    candidates_.of_fibers = upload(topology.candidates_of_fibers, candidates_of_fibers_);
    candidates_.first_segments = upload(topology.candidate_segments, candidate_segments_);
    candidates_.first_points = upload(topology.candidate_points, candidate_points_);
    candidates_.count = static_cast<std::uint32_t>(topology.candidate_points.size()) - 1;
    candidates_.point_end = topology.candidate_points.back();
    candidates_.segment_end = topology.candidate_segments.back();
  }

  template <class Number>
  void update_from(const HostFibers& fibers, const Number* coordinates) {
    const Turn turn(*executor_);
    view_ = {};
    if (segment_count_ == 0) {
      return;
    }
    executor_->require_own(coordinates);
    executor_->wait_for_others();
    const auto count = static_cast<std::uint32_t>(3 * fibers.point_count);
    coordinates_.resize(count);
    clock_.start(*executor_);
    executor_->for_each(count, TakePoints<Number>{coordinates, coordinates_.data()});
    clock_.end(*executor_, "points");
    if (build(fibers) != 0) {
      std::vector<double> there(count);
      executor_->download(coordinates_, 0, count, there.data());
      HostFibers named = fibers;
      named.coordinates = there.data();
      refuse_points(named);
    }
  }

  /// Builds the tree over the coordinates that are there.
  /// @return how many of them fibres may not have; there is no tree then
  std::uint64_t build(const HostFibers& fibers) {
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
    bad_count_.resize(1);
    executor_->zero(bad_count_);
    sort(points_);
    SegmentTreeView view;
    fit(points_, view);
    clock_.end(*executor_, "tree");
    std::uint64_t bad_count = 0;
    executor_->download(bad_count_, 0, 1, &bad_count);
    if (bad_count == 0) {
      view_ = view;
    }
    return bad_count;
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
    executor_->for_each_warp(count, BoundPoints{points, bounds, bad_count_.data()});
    while (count > 1) {
      executor_->for_each_warp(in_warps(count),
                               JoinBoxes<PointBounds>{bounds, count, bounds + count});
      bounds += count;
      count = in_warps(count);
    }
    clock_.end(*executor_, "bounds");
    keys_.resize(segment_count_);
    order_.resize(segment_count_);
    const int candidate_bits = candidates_.exist() ? bits_of(candidates_.count) : 0;
    const int position_bits = std::min(PlaceSegments::max_bits, key_bits - candidate_bits);
    executor_->for_each(segment_count_, PlaceSegments{points, bounds, keys_.data(), order_.data(),
                                                      candidates_, fibers_.data(), position_bits});
    executor_->sort_by_key(keys_, order_, segment_count_, candidate_bits + position_bits);
    clock_.end(*executor_, "order");
  }

  /// How many bits numbers up to this one have.
  static int bits_of(std::uint32_t number) {
    int bits = 1;
    while (number >> bits != 0) {
      ++bits;
    }
    return bits;
  }

  /// Fits the boxes to them.
  void fit(const TreePoints& points, SegmentTreeView& view) {
    segments_.resize(segment_count_);
    executor_->for_each(segment_count_, ReadSegments{points, order_.data(), segments_.data()});
    view.segments = segments_.data();
    view.segment_count = segment_count_;
    std::uint32_t count = in_warps(segment_count_);
    for (int level = 0;; ++level) {
      boxes_[level].resize(count);
      TreeBox* const boxes = boxes_[level].data();
      if (level == 0) {
        executor_->for_each_warp(count, FitLeaves{segments_.data(), segment_count_, boxes});
      } else {
        executor_->for_each_warp(
            count, JoinBoxes<TreeBox>{view.boxes[level - 1], view.box_counts[level - 1], boxes});
      }
      view.boxes[level] = boxes;
      view.box_counts[level] = count;
      view.level_count = level + 1;
      if (count <= warp_width) {
        return;
      }
      count = in_warps(count);
    }
  }

  template <class T>
  using Buffer = typename Executor::template Buffer<T>;

  static constexpr int key_bits = 32;

  std::shared_ptr<Executor> executor_;
  std::uint32_t segment_count_ = 0;
  Buffer<std::uint32_t> first_points_;
  Buffer<std::uint32_t> fibers_;
  Buffer<std::uint32_t> candidates_of_fibers_;
  Buffer<std::uint32_t> candidate_points_;
  Buffer<std::uint32_t> candidate_segments_;
  CandidateView candidates_;
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

}  // namespace fiber

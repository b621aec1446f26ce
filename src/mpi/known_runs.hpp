#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/mpi/fiber_runs.hpp"
#include "src/mpi/local_fibers.hpp"
#include "src/query/loop_rule.hpp"

namespace fiber {

/// Whether a fibre makes a loop between two of its segments, where this rank does not have all
/// points between them. The points to look at start the segments after a, up to b.
struct LoopQuestion {
  std::uint64_t fiber = 0;
  std::uint64_t segment_a = 0;  // index along the fibre, the smaller one
  std::uint64_t segment_b = 0;
  Capsule a;
  Capsule b;

  GlobalSegment first() const { return {fiber, segment_a + 1}; }
};

/// Runs of a rank that loops are looked for in, with boxes.
class KnownRuns {
 public:
  explicit KnownRuns(const LocalFibers& fibers) : fibers_(fibers) {}

  /// How many of the points asked about are here.
  std::uint64_t count(const LoopQuestion& question) const {
    std::uint64_t count = 0;
    for (auto run = first_run(question); is_asked(run, question); ++run) {
      const std::uint64_t begin = std::max(run->first.segment, question.segment_a + 1);
      const std::uint64_t end = std::min(run->first.segment + run->count, question.segment_b + 1);
      count += run->first.fiber == question.fiber && begin < end ? end - begin : 0;
    }
    return count;
  }

  /// Whether any of the points asked about that are here is beyond either limit.
  bool any_beyond(const LoopQuestion& question, const LoopReach& x, const LoopReach& y) {
    for (auto run = first_run(question); is_asked(run, question); ++run) {
      if (run->first.fiber == question.fiber && any_beyond(*run, question, x, y)) {
        return true;
      }
    }
    return false;
  }

 private:
  using Run = std::vector<FiberRun>::const_iterator;

  Run first_run(const LoopQuestion& question) const {
    const std::vector<FiberRun>& runs = fibers_.runs();
    const auto run = std::upper_bound(
        runs.begin(), runs.end(), question.first(),
        [](const GlobalSegment& first, const FiberRun& other) { return first < other.first; });
    return run == runs.begin() ? run : run - 1;  // may have begun before
  }
  bool is_asked(Run run, const LoopQuestion& question) const {
    return run != fibers_.runs().end() &&
           !(GlobalSegment{question.fiber, question.segment_b} < run->first);
  }

  bool any_beyond(const FiberRun& run, const LoopQuestion& question, const LoopReach& x,
                  const LoopReach& y) {
    const Eigen::AlignedBox3d& box = box_of(run);
    if (x.holds(box) && y.holds(box)) {
      return false;
    }
    for (std::uint64_t i = 0; i < run.count; ++i) {
      const std::uint64_t segment = run.first.segment + i;
      const Eigen::Vector3d& point = fibers_.fibers().points()[run.begin + i];
      if (segment > question.segment_a && segment <= question.segment_b &&
          (x.is_beyond(point) || y.is_beyond(point))) {
        return true;
      }
    }
    return false;
  }

  /// A box around the points of the run that start a segment.
  const Eigen::AlignedBox3d& box_of(const FiberRun& run) {
    boxes_.resize(fibers_.runs().size());
    Eigen::AlignedBox3d& box = boxes_[static_cast<std::size_t>(&run - fibers_.runs().data())];
    const bool is_new = box.isEmpty();
    for (std::uint64_t i = 0; is_new && i < run.count; ++i) {
      box.extend(fibers_.fibers().points()[run.begin + i]);
    }
    return box;
  }

  const LocalFibers& fibers_;
  std::vector<Eigen::AlignedBox3d> boxes_;  // empty where they were not needed yet
};

}  // namespace fiber

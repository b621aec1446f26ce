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

/// Who owns segments of a fibre that follow each other.
struct OwnedRun {
  GlobalSegment first;
  std::uint64_t count = 0;
  int rank = 0;
};

/// A question about a loop as it travels.
struct PlainLoopQuestion {
  GlobalSegment first;     // whose start is the first point to look at
  std::uint64_t last = 0;  // segment whose start is the last one
  PlainPoint a0{}, a1{}, b0{}, b1{};
  double radius_a = 0.0;
  double radius_b = 0.0;
};

/// Runs of a rank that loops are looked for in, with boxes.
class KnownRuns {
 public:
  explicit KnownRuns(const LocalFibers& fibers) : fibers_(fibers) {}

  /// Those that follow each other as one.
  std::vector<OwnedRun> joined(int rank) const {
    std::vector<OwnedRun> runs;
    for (const FiberRun& run : fibers_.runs()) {
      if (!runs.empty() && runs.back().first.fiber == run.first.fiber &&
          runs.back().first.segment + runs.back().count == run.first.segment) {
        runs.back().count += run.count;
      } else {
        runs.push_back({run.first, run.count, rank});
      }
    }
    return runs;
  }

  /// How many of the points asked about are here.
  std::uint64_t count(const PlainLoopQuestion& question) const {
    std::uint64_t count = 0;
    for (auto run = first_run(question); is_asked(run, question); ++run) {
      const std::uint64_t begin = std::max(run->first.segment, question.first.segment);
      const std::uint64_t end = std::min(run->first.segment + run->count, question.last + 1);
      count += run->first.fiber == question.first.fiber && begin < end ? end - begin : 0;
    }
    return count;
  }

  /// Whether any of the points asked about that are here is beyond either limit.
  bool any_beyond(const PlainLoopQuestion& question, const LoopReach& x, const LoopReach& y) {
    for (auto run = first_run(question); is_asked(run, question); ++run) {
      if (run->first.fiber == question.first.fiber && any_beyond(*run, question, x, y)) {
        return true;
      }
    }
    return false;
  }

 private:
  using Run = std::vector<FiberRun>::const_iterator;

  Run first_run(const PlainLoopQuestion& question) const {
    const std::vector<FiberRun>& runs = fibers_.runs();
    const auto run = std::upper_bound(
        runs.begin(), runs.end(), question.first,
        [](const GlobalSegment& first, const FiberRun& other) { return first < other.first; });
    return run == runs.begin() ? run : run - 1;  // may have begun before
  }
  bool is_asked(Run run, const PlainLoopQuestion& question) const {
    return run != fibers_.runs().end() &&
           !(GlobalSegment{question.first.fiber, question.last} < run->first);
  }

  bool any_beyond(const FiberRun& run, const PlainLoopQuestion& question, const LoopReach& x,
                  const LoopReach& y) {
    const Eigen::AlignedBox3d& box = box_of(run);
    if (x.holds(box) && y.holds(box)) {
      return false;
    }
    for (std::uint64_t i = 0; i < run.count; ++i) {
      const std::uint64_t segment = run.first.segment + i;
      const Eigen::Vector3d& point = fibers_.fibers().points()[run.begin + i];
      if (segment >= question.first.segment && segment <= question.last &&
          (x.is_beyond(point) || y.is_beyond(point))) {
        return true;
      }
    }
    return false;
  }

  /// Around the points that start a segment.
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

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "src/query/touch_tracker.hpp"

namespace fiber {

/// The kind of pairs that are in no run.
constexpr std::uint64_t no_kind = std::numeric_limits<std::uint64_t>::max();

/// Finds the runs of pairs: as long as they can be, of one kind, of one segment a with consecutive
/// segments b. Images are labelled by such runs as well (He, Chao and Suzuki, "A Run-Based Two-Scan
/// Labeling Algorithm", IEEE Transactions on Image Processing, 2008).
/// @param pairs   sorted by key
/// @param kind_of a pair's index
template <class Pair, class KindOf>
void find_touch_runs(const std::vector<Pair>& pairs, const KindOf& kind_of,
                     std::vector<TouchRun>& runs) {
  runs.clear();
  std::uint64_t kind = no_kind;  // of the pair before
  for (std::uint32_t i = 0; i < pairs.size(); ++i) {
    const std::uint64_t kind_before = std::exchange(kind, kind_of(i));
    if (kind == no_kind) {
      continue;
    }
    const std::uint64_t a = TouchRun::number_of(pairs[i].fiber_a, pairs[i].segment_a);
    const std::uint64_t b = TouchRun::number_of(pairs[i].fiber_b, pairs[i].segment_b);
    if (kind == kind_before && runs.back().a == a && b - runs.back().last_b <= 1) {
      runs.back().last_b = b;
      runs.back().end = i + 1;
    } else {
      runs.push_back({a, b, b, i, i + 1, kind});
    }
  }
}

/// Finds, among runs, the neighbours of one run after the other: those that have a pair whose
/// segments are the same as those of one of its pairs, or next to them. As those that are asked
/// about are sorted, too, each place is passed once only; what is next to it across a seam is
/// looked up.
class NearTouchRuns {
 public:
  /// Both must outlive this.
  NearTouchRuns(const std::vector<TouchRun>& runs, const TouchSeams& seams)
      : runs_(runs), seams_(seams) {}

  /// Calls for the index of each neighbour before `end`, for some more than once.
  /// @param run,end neither less than in the call before
  template <class Use>
  void for_each(const TouchRun& run, std::size_t end, const Use& use) {
    const std::uint64_t min_b =
        TouchRun::segment_of(run.first_b) == 0 ? run.first_b : run.first_b - 1;
    // The first segment and each one next to it have a place of their own.
    for (std::uint32_t row = TouchRun::segment_of(run.a) == 0 ? 1 : 0; row < 3; ++row) {
      const std::uint64_t a = run.a + row - 1;
      std::size_t& begin = begins_[row];
      while (begin < end && ends_before(runs_[begin], a, min_b)) {
        ++begin;
      }
      for (std::size_t i = begin; i < end && begins_by(runs_[i], a, run.last_b + 1); ++i) {
        use(i);
      }
    }
    if (!seams_.last_segments.empty()) {
      for_each_across_seams(run, end, use);
    }
  }

 private:
  static bool ends_before(const TouchRun& run, std::uint64_t a, std::uint64_t b) {
    return run.a < a || (run.a == a && run.last_b < b);
  }

  static bool begins_by(const TouchRun& run, std::uint64_t a, std::uint64_t b) {
    return run.a == a && run.first_b <= b;
  }

  /// A segment, and whether a seam is between it and the one whose neighbour it is.
  struct Near {
    std::uint64_t segment;
    bool is_across;
  };

  /// The last segment of the closed fibre that a segment is of; 0 if it is not closed.
  std::uint32_t last_of(std::uint64_t segment) const {
    const std::uint32_t fiber = TouchRun::fiber_of(segment);
    return fiber < seams_.last_segments.size() ? seams_.last_segments[fiber] : 0;
  }

  /// A segment and those next to it.
  /// @param last of its fibre, 0 if that is open
  static std::array<Near, 3> around(std::uint64_t segment, std::uint32_t last) {
    const std::uint32_t index = TouchRun::segment_of(segment);
    const bool is_first = last > 0 && index == 0;
    const bool is_last = last > 0 && index == last;
    return {{{segment, false},
             {is_first ? segment + last : segment - 1, is_first},
             {is_last ? segment - last : segment + 1, is_last}}};
  }

  template <class Use>
  void for_each_across_seams(const TouchRun& run, std::size_t end, const Use& use) const {
    const std::uint32_t last_a = last_of(run.a);
    const std::uint32_t last_b = seams_.are_of_both ? last_of(run.first_b) : 0;
    if (last_a == 0 && last_b == 0) {
      return;
    }
    const std::array<Near, 3> near_a = around(run.a, last_a);
    for (std::uint64_t segment_b = run.first_b; segment_b <= run.last_b; ++segment_b) {
      for (const Near& b : around(segment_b, last_b)) {
        for (const Near& a : near_a) {
          if (a.is_across || b.is_across) {
            use_runs_with(a.segment, b.segment, end, use);
          }
        }
      }
    }
  }

  /// Calls for the runs before `end` that have this pair.
  template <class Use>
  void use_runs_with(std::uint64_t a, std::uint64_t b, std::size_t end, const Use& use) const {
    if (seams_.are_of_both && b < a) {
      std::swap(a, b);
    }
    const auto limit = runs_.begin() + static_cast<std::ptrdiff_t>(end);
    auto run = std::partition_point(runs_.begin(), limit,
                                    [&](const TouchRun& each) { return ends_before(each, a, b); });
    for (; run != limit && begins_by(*run, a, b); ++run) {
      use(static_cast<std::size_t>(run - runs_.begin()));
    }
  }

  const std::vector<TouchRun>& runs_;
  const TouchSeams& seams_;
  std::size_t begins_[3] = {};
};

}  // namespace fiber

#pragma once

#include <cstdint>

#include "src/cuda/warp.hpp"

namespace fiber {

/// Fibres that are assemblies of their own, one after the other in one tree, and what stands still
/// among them. Their segments are runs of the tree, in the same order; what stands still comes
/// last. So a candidate's pairs are looked for in few nodes, however many others overlap it.
struct CandidateView {
  std::uint32_t count = 0;
  const std::uint32_t* of_fibers = nullptr;       ///< by fibre; count for those that stand still
  const std::uint32_t* first_points = nullptr;    ///< by candidate, and of what stands still
  const std::uint32_t* first_segments = nullptr;  ///< the same, in the tree
  std::uint32_t point_end = 0;                    ///< of the candidates
  std::uint32_t segment_end = 0;

  /// Whether fibres are told apart so at all.
  FIBER_ON_DEVICE bool exist() const { return first_points != nullptr; }

  /// Where the segments end of a candidate, or, of what stands still, those of all candidates.
  FIBER_ON_DEVICE std::uint32_t end_of(std::uint32_t candidate) const {
    return first_segments[candidate < count ? candidate + 1 : count];
  }
};

/// Leaves of the tree that have what the candidates of one leaf may meet: those before `own_end`,
/// and those from `still_begin` on.
struct CandidateLeaves {
  static constexpr std::uint32_t none = 0xFFFFFFFFU;
  static constexpr int bits_per_level = 5;

  std::uint32_t own_end = none;
  std::uint32_t still_begin = none;

  /// Whether leaves begin … end − 1 have any.
  FIBER_ON_DEVICE bool meet(std::uint64_t begin, std::uint64_t end) const {
    return begin < own_end || end > still_begin;
  }

  /// Calls with the level and number of the nodes that all of them are below, from one leaf on: of
  /// the lowest ones, two for each of the two runs at most, as most candidates are small beside the
  /// tree.
  template <class Call>
  FIBER_ON_DEVICE void each_start(std::uint32_t leaf, std::uint32_t leaf_count, int top,
                                  const Call& call) const {
    const Nodes own = nodes_of(leaf, own_end, top);
    const Nodes still = nodes_of(still_begin > leaf ? still_begin : leaf, leaf_count, top);
    const bool has_own = leaf < own_end;
    const bool has_still = still_begin != none;
    const bool are_apart = own.end() <= still.begin();
    if (own_end == none || (has_own && has_still && !are_apart)) {
      call(top, 0U);
      return;
    }
    if (has_own) {
      own.each(call);
    }
    if (has_still) {
      still.each(call);
    }
  }

 private:
  /// One node, or two that follow each other.
  struct Nodes {
    int level;
    std::uint32_t first;
    std::uint32_t last;

    FIBER_ON_DEVICE std::uint64_t begin() const {
      return std::uint64_t{first} << (bits_per_level * level);
    }
    FIBER_ON_DEVICE std::uint64_t end() const {
      return (std::uint64_t{last} + 1) << (bits_per_level * level);
    }
    template <class Call>
    FIBER_ON_DEVICE void each(const Call& call) const {
      call(level, first);
      if (last != first) {
        call(level, last);
      }
    }
  };

  /// The lowest nodes that leaves begin … end − 1 are below, if there are any.
  FIBER_ON_DEVICE static Nodes nodes_of(std::uint32_t begin, std::uint32_t end, int top) {
    const std::uint64_t last = end > begin ? end - 1 : begin;
    int level = 1;
    while (level < top &&
           (last >> (bits_per_level * level)) - (std::uint64_t{begin} >> (bits_per_level * level)) >
               1) {
      ++level;
    }
    return {level, static_cast<std::uint32_t>(std::uint64_t{begin} >> (bits_per_level * level)),
            static_cast<std::uint32_t>(last >> (bits_per_level * level))};
  }
};

/// Where the contacts of each candidate begin, and where those of the last one end.
struct FindCandidates {
  CandidateView candidates;
  const std::uint32_t* a;  ///< of contacts, sorted: points of candidates, as what stands comes last
  std::uint32_t contact_count;
  std::uint32_t* begins;  ///< candidate count + 1

  FIBER_ON_DEVICE void operator()(std::uint32_t candidate) const {
    const std::uint32_t point = candidates.first_points[candidate];
    std::uint32_t begin = 0;
    std::uint32_t end = contact_count;
    while (begin < end) {
      const std::uint32_t middle = begin + (end - begin) / 2;
      if (a[middle] < point) {
        begin = middle + 1;
      } else {
        end = middle;
      }
    }
    begins[candidate] = begin;
  }
};

}  // namespace fiber

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "src/query/touch_tracker.hpp"

namespace fiber {

/// Finds, among pairs sorted by key, the neighbours of one pair after the other: those whose
/// segments are the same, or next to them. As those that are asked about are sorted, too, each
/// place is passed once only; what is next to it across a seam is looked up.
template <class Pair>
class TouchNeighbours {
 public:
  /// Both must outlive this.
  TouchNeighbours(const std::vector<Pair>& pairs, const TouchSeams& seams)
      : pairs_(pairs), seams_(seams) {}

  /// Calls for the index of each neighbour before `end`, for some more than once.
  /// @param other,end neither less than in the call before
  template <class Other, class Use>
  void for_each(const Other& other, std::size_t end, const Use& use) {
    const std::uint64_t b = number_of(other.fiber_b, other.segment_b);
    const std::uint64_t min_b = other.segment_b == 0 ? b : b - 1;
    // The first segment and each one next to it have a place of their own.
    for (std::uint32_t row = other.segment_a == 0 ? 1 : 0; row < 3; ++row) {
      const std::uint64_t a = number_of(other.fiber_a, other.segment_a) + row - 1;
      std::size_t& begin = begins_[row];
      while (begin < end && is_before(pairs_[begin], a, min_b)) {
        ++begin;
      }
      for (std::size_t i = begin; i < end && is_before(pairs_[i], a, b + 2); ++i) {
        use(i);
      }
    }
    if (!seams_.last_segments.empty()) {
      for_each_across_seams(other, end, use);
    }
  }

  /// Calls for the index of each neighbour of a pair that comes before it, for some more than once.
  /// @param index not less than in the call before
  template <class Use>
  void for_each_earlier(std::size_t index, const Use& use) {
    const Pair& pair = pairs_[index];
    const std::uint64_t a = number_of(pair.fiber_a, pair.segment_a);
    const std::uint64_t b = number_of(pair.fiber_b, pair.segment_b);
    const std::uint64_t min_b = pair.segment_b == 0 ? b : b - 1;
    for (std::size_t i = index; i > 0 && !is_before(pairs_[i - 1], a, min_b); --i) {
      use(i - 1);
    }
    if (pair.segment_a > 0) {
      std::size_t& begin = begins_[0];
      while (is_before(pairs_[begin], a - 1, min_b)) {
        ++begin;
      }
      for (std::size_t i = begin; is_before(pairs_[i], a - 1, b + 2); ++i) {
        use(i);
      }
    }
    if (!seams_.last_segments.empty()) {
      for_each_across_seams(pair, index, use);
    }
  }

 private:
  /// A segment as one number, in the order of fibre and index.
  static std::uint64_t number_of(std::uint32_t fiber, std::uint32_t segment) {
    return std::uint64_t{fiber} << 32 | segment;
  }

  static bool is_before(const Pair& pair, std::uint64_t a, std::uint64_t b) {
    const std::uint64_t pair_a = number_of(pair.fiber_a, pair.segment_a);
    return pair_a < a || (pair_a == a && number_of(pair.fiber_b, pair.segment_b) < b);
  }

  /// A segment, and whether a seam is between it and the one whose neighbour it is.
  struct Near {
    std::uint32_t segment;
    bool is_across;
  };

  /// A segment and those next to it.
  std::vector<Near> around(std::uint32_t fiber, std::uint32_t segment, bool may_be_closed) const {
    const std::uint32_t last =
        may_be_closed && fiber < seams_.last_segments.size() ? seams_.last_segments[fiber] : 0;
    std::vector<Near> near{{segment, false}};
    if (segment > 0) {
      near.push_back({segment - 1, false});
    } else if (last > 0) {
      near.push_back({last, true});
    }
    near.push_back(last > 0 && segment == last ? Near{0, true} : Near{segment + 1, false});
    return near;
  }

  template <class Other, class Use>
  void for_each_across_seams(const Other& other, std::size_t end, const Use& use) const {
    const std::vector<Near> near_b = around(other.fiber_b, other.segment_b, seams_.are_of_both);
    for (const Near& a : around(other.fiber_a, other.segment_a, true)) {
      for (const Near& b : near_b) {
        if (a.is_across || b.is_across) {
          use_pairs_of(number_of(other.fiber_a, a.segment), number_of(other.fiber_b, b.segment),
                       end, use);
        }
      }
    }
  }

  template <class Use>
  void use_pairs_of(std::uint64_t a, std::uint64_t b, std::size_t end, const Use& use) const {
    if (seams_.are_of_both && b < a) {
      std::swap(a, b);
    }
    const auto limit = pairs_.begin() + static_cast<std::ptrdiff_t>(end);
    auto pair = std::partition_point(pairs_.begin(), limit,
                                     [&](const Pair& each) { return is_before(each, a, b); });
    for (; pair != limit && is_before(*pair, a, b + 1); ++pair) {
      use(static_cast<std::size_t>(pair - pairs_.begin()));
    }
  }

  const std::vector<Pair>& pairs_;
  const TouchSeams& seams_;
  std::size_t begins_[3] = {};
};

}  // namespace fiber

#pragma once

#include <cstdint>

#include "src/cuda/candidates.hpp"
#include "src/cuda/judge_pairs.hpp"
#include "src/cuda/write_pairs.hpp"

namespace fiber {

/// Decides about pairs as they are found, and marks the candidates that touch something: the first
/// contact ends what is looked for of a candidate. Contacts of one fibre that need a loop are
/// written down, as the host knows the rule; but for those that surely have none.
struct MarkTouching {
  TreePoints points;
  double margin;                ///< [m]
  const std::uint32_t* fibers;  ///< by point
  CandidateView candidates;
  bool needs_loops;         ///< of contacts of one fibre
  std::uint32_t* touching;  ///< by candidate, 1 or 0
  WritePairs asked;

  /// Marks are seen early or late; what is missed by it is only looked for in vain. Lanes may see
  /// them at different times, and must not go different ways for it.
  template <class Warp>
  FIBER_ON_DEVICE bool is_over(Warp warp, std::uint32_t first, std::uint32_t last) const {
    return warp.ballot([&](int /*lane*/) { return are_marked(first, last); }) != 0;
  }

  template <class Warp, class Key>
  FIBER_ON_DEVICE void take(Warp warp, std::uint32_t lanes, const Key& key) const {
    const std::uint32_t loops = warp.ballot(
        [&](int lane) { return (lanes & bit_of(lane)) != 0 && needs_to_be_asked(key(lane)); });
    if (loops != 0) {
      asked.take(warp, loops, key);
    }
  }

 private:
  FIBER_ON_DEVICE bool are_marked(std::uint32_t first, std::uint32_t last) const {
    for (std::uint32_t candidate = first; candidate <= last && candidate < candidates.count;
         ++candidate) {
      if (!is_marked(candidate)) {
        return false;
      }
    }
    return true;
  }

  /// Marks the candidate of a contact, unless that needs a loop.
  FIBER_ON_DEVICE bool needs_to_be_asked(std::uint64_t key) const {
    const auto a = static_cast<std::uint32_t>(key >> 32U);
    const auto b = static_cast<std::uint32_t>(key);
    const JudgedPair judged = judged_pair(points, a, b);
    if (!(judged.gap <= margin)) {
      return false;
    }
    if (needs_loops && fibers[a] == fibers[b]) {
      return !surely_has_no_loop(a, b, judged);
    }
    mark(candidates.of_fibers[fibers[a]]);
    return false;
  }

  FIBER_ON_DEVICE double length(std::uint32_t point) const {
    const double* const p = points.coordinates + 3 * std::size_t{point};
    const double x = p[3] - p[0];
    const double y = p[4] - p[1];
    const double z = p[5] - p[2];
    return sqrt(x * x + y * y + z * z);
  }

  /// Whether the way along the fibre is too short for a point on it to be as far away as the rule
  /// of LoopTest asks: 5/4 of the distance and 5/2 radii, for other places on the two segments less
  /// the longer of these (LoopCriteria::of_all()).
  FIBER_ON_DEVICE bool surely_has_no_loop(std::uint32_t a, std::uint32_t b,
                                          const JudgedPair& judged) const {
    constexpr std::uint32_t furthest = 16;  // more points take long, and seldom are so near
    if (b - a > furthest) {
      return false;
    }
    const double length_a = length(a);
    const double length_b = length(b);
    double between = 0.0;
    for (std::uint32_t point = a + 1; point < b; ++point) {
      between += length(point);
    }
    const double from_a = (1.0 - judged.s) * length_a;
    const double from_b = judged.t * length_b;
    const double way = between + (from_a > from_b ? from_a : from_b);
    const double radius_a = points.radius_of(a);
    const double radius_b = points.radius_of(b);
    const double radii = radius_a + radius_b;
    const double larger = radius_a > radius_b ? radius_a : radius_b;
    const double limit =
        1.25 * (judged.gap + radii) + 2.5 * larger - (length_a > length_b ? length_a : length_b);
    // Rounding may take away so much, also of coordinates that are much larger than the segments:
    // pairs this near are left to the host.
    constexpr double rounding = 1e-9;
    constexpr double least = 1e-100;  // squares of what is much shorter are lost
    return limit > least && way < limit - rounding * (way + radii + length_a + length_b);
  }

  FIBER_ON_DEVICE bool is_marked(std::uint32_t candidate) const {
#ifdef __CUDA_ARCH__
    return *static_cast<const volatile std::uint32_t*>(touching + candidate) != 0;
#else
    return __atomic_load_n(touching + candidate, __ATOMIC_RELAXED) != 0;
#endif
  }
  FIBER_ON_DEVICE void mark(std::uint32_t candidate) const {
#ifdef __CUDA_ARCH__
    *static_cast<volatile std::uint32_t*>(touching + candidate) = 1;
#else
    __atomic_store_n(touching + candidate, 1U, __ATOMIC_RELAXED);
#endif
  }
};

/// Brings some points together.
struct GatherPoints {
  const double* coordinates;
  const std::uint32_t* points;
  double* gathered;

  FIBER_ON_DEVICE void operator()(std::uint32_t index) const {
    const double* const from = coordinates + 3 * std::size_t{points[index]};
    double* const to = gathered + 3 * std::size_t{index};
    for (int axis = 0; axis < 3; ++axis) {
      to[axis] = from[axis];
    }
  }
};

}  // namespace fiber

#include "fiber_proximity/query/unsimplified_pairs.hpp"

#include <algorithm>
#include <limits>

namespace fiber {

using Eigen::Vector3d;

UnsimplifiedPairs::UnsimplifiedPairs(const FiberAssembly& fibers,
                                     const SimplifiedFibers& simplified,
                                     const QueryOptions& options)
    : fibers_(fibers),
      simplified_(simplified),
      test_(fibers, options),
      wants_adjacent_(test_.wants_adjacent()) {
  if (options.needs_loops()) {
    // A loop is one of the fibre, not of its pieces.
    neighbour_skip_ = std::numeric_limits<std::uint32_t>::max();
    return;
  }
  const std::vector<std::uint32_t>& offsets = simplified.assembly().offsets();
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const std::uint32_t end = offsets[fiber + 1] - 1;
    // The first piece beyond all neighbours of a piece moves on as the piece does: the nearest two
    // segments of a pair of pieces tell.
    std::uint32_t far = offsets[fiber];
    for (std::uint32_t piece = offsets[fiber]; piece < end; ++piece) {
      far = std::max(far, piece + 1);
      while (far < end &&
             test_.is_left_out({simplified.run_end(piece) - 1, simplified.run_begin(far)})) {
        ++far;
      }
      neighbour_skip_ = std::max(neighbour_skip_, far - piece - 1);
    }
  }
}

void UnsimplifiedPairs::offer(PairCollector& collector) {
  const std::vector<std::uint32_t>& offsets = simplified_.assembly().offsets();
  for (std::uint32_t fiber = 0; fiber < fibers_.fiber_count(); ++fiber) {
    std::uint32_t first = fibers_.offsets()[fiber];
    for (std::uint32_t piece = offsets[fiber]; piece + 1 < offsets[fiber + 1]; ++piece) {
      if (collector.done()) {
        return;
      }
      const std::uint32_t end = window_end(piece, fiber);
      first = first_far(simplified_.run_begin(piece), first, end);
      if (first < end && !test_.rules_out(simplified_.run_begin(piece), end - 1) &&
          !are_far({piece, end, first}, collector.bound())) {
        offer_within({piece, end, first}, collector);
      }
    }
  }
}

/// One past the last segment of the pieces that are left to us with this one.
std::uint32_t UnsimplifiedPairs::window_end(std::uint32_t piece, std::uint32_t fiber) const {
  const std::uint32_t last = simplified_.assembly().offsets()[fiber + 1] - 2;
  return simplified_.run_end(piece + std::min(neighbour_skip_, last - piece));
}

/// The first segment behind this one, not before `from` and not beyond the end, that is no
/// neighbour of it; does not decrease along a fibre.
std::uint32_t UnsimplifiedPairs::first_far(std::uint32_t segment, std::uint32_t from,
                                           std::uint32_t end) const {
  std::uint32_t far = std::max(from, segment + 1);
  while (far < end && test_.is_left_out({segment, far})) {
    ++far;
  }
  return far;
}

/// Whether a glance at the pieces shows that no pair of the window is within the bound [m], as is
/// common: of a piece P with itself, and with the next one, Q. The advances of P and Q are at least
/// a > 0. Two segments of P that share no point have one between them, so they are a apart. Of two
/// of P and Q, one is not at the corner where these meet: its points are within e of axis points
/// that are a from the corner, those of the other within f of the other axis. That turns by less
/// than a right angle, so it comes no nearer to them than the corner: they are a − e − f apart.
/// The radii of the pieces have e and f in them.
bool UnsimplifiedPairs::are_far(const Window& window, double bound) const {
  if (wants_adjacent_ || neighbour_skip_ > 1) {
    return false;
  }
  const FiberAssembly& pieces = simplified_.assembly();
  const std::uint32_t p = window.piece;
  const Vector3d u = pieces.points()[p + 1] - pieces.points()[p];
  double apart = simplified_.advance(p);
  double radius = pieces.segment_radius(p);
  double length = u.norm();
  if (simplified_.run_end(p) < window.end) {
    const std::uint32_t q = p + 1;
    const Vector3d v = pieces.points()[q + 1] - pieces.points()[q];
    const double length_of_q = v.norm();
    constexpr double least_cosine = 0x1p-40;  // its rounding is far below
    if (!(u.dot(v) > least_cosine * length * length_of_q)) {
      return false;
    }
    apart = std::min(apart, simplified_.advance(q));
    radius = std::max(radius, pieces.segment_radius(q));
    length += length_of_q;
  }
  const double limit = bound + 2.0 * radius;
  return apart > limit + 0x1p-44 * (limit + length) + 0x1p-500;  // and where squares underflow
}

/// Segments are apart at least by what they are apart along any direction. Along that of the window
/// a straight fibre leaves a segment behind soon: `least_` tells how far all that follows has come.
void UnsimplifiedPairs::offer_within(const Window& window, PairCollector& collector) {
  const std::vector<Vector3d>& points = fibers_.points();
  const std::uint32_t begin = simplified_.run_begin(window.piece);
  const Vector3d& origin = points[begin];
  // Subnormal vectors get their unit length in two steps.
  const Vector3d axis = (points[window.end] - origin).stableNormalized().normalized();
  const auto along = [&](std::uint32_t point) { return axis.dot(points[point] - origin); };
  double radius = 0.0;
  for (std::uint32_t piece = window.piece; simplified_.run_begin(piece) < window.end; ++piece) {
    radius = std::max(radius, simplified_.assembly().segment_radius(piece));
  }
  least_.resize(window.end + 1 - window.first);
  double extent = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (std::uint32_t i = window.end + 1; i-- > window.first;) {
    extent = std::max(extent, (points[i] - origin).cwiseAbs().sum());
    least = std::min(least, along(i));
    least_[i - window.first] = least;
  }
  std::uint32_t far = window.first;
  for (std::uint32_t i = begin; i < simplified_.run_end(window.piece); ++i) {
    far = first_far(i, far, window.end);
    const double most = std::max(along(i), along(i + 1));
    const double reach = extent + (points[i + 1] - origin).cwiseAbs().sum() + 2.0 * radius;
    for (std::uint32_t j = far; j < window.end; ++j) {
      // Roundings are a few units of 2⁻⁵³ of all that is added up here, or of the smallest double.
      const double bound = collector.bound();
      const double limit = bound + 2.0 * radius + 0x1p-44 * (bound + reach) + 0x1p-1068;
      if (least_[j - window.first] - most > limit || collector.done()) {
        break;
      }
      collector.offer(i, j);
    }
  }
}

}  // namespace fiber

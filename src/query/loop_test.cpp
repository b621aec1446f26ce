#include "fiber_proximity/query/loop_test.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>

#include "src/geometry/norm.hpp"
#include "src/query/loop_chain.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

// How far the fibre must go from two places: this part of their distance, and so many radii.
constexpr double part_of_distance = 1.25;
constexpr double count_of_radii = 2.5;

// So few points are looked at one by one: that takes no longer than the distance of the pair.
constexpr std::uint32_t short_walk = 64;

double thinnest_radius(const FiberAssembly& fibers, std::uint32_t fiber) {
  double radius = fibers.largest_radius();
  for (std::uint32_t i = fibers.offsets()[fiber]; i + 1 < fibers.offsets()[fiber + 1]; ++i) {
    radius = std::min(radius, fibers.segment_radius(i));
  }
  return radius;
}

/// [m] At least the length of every segment.
double longest_step(const FiberAssembly& fibers, std::uint32_t fiber) {
  double longest = 0.0;
  for (std::uint32_t i = fibers.offsets()[fiber] + 1; i < fibers.offsets()[fiber + 1]; ++i) {
    longest = std::max(longest, norm_of(fibers.points()[i] - fibers.points()[i - 1]));
  }
  return longest * (1.0 + 0x1p-40);
}

}  // namespace

/// What is worth knowing of a fibre for long walks along it.
struct LoopTest::Chain {
  void fit(const FiberAssembly& fibers, std::uint32_t fiber) {
    step = longest_step(fibers, fiber);
    stretches.find(fibers, fiber, thinnest_radius(fibers, fiber));
    boxes.fit(fibers, fiber);
  }

  double step = 0.0;  // [m] no two points that follow each other are further apart
  LoopFreeStretches stretches;
  PointBoxes boxes;
};

struct LoopTest::Slot {
  std::atomic<bool> is_filled{false};
  std::unique_ptr<Chain> chain;  // may be that of fibres before these, for its memory
};

/// A place on a segment, as the sum of its nearer end and the way from there: what is near the end
/// is then known to all digits.
struct LoopTest::Place {
  Vector3d end;
  Vector3d way;
};

LoopTest::LoopTest() = default;

LoopTest::LoopTest(const FiberAssembly& fibers) { reset(fibers); }

LoopTest::~LoopTest() = default;

void LoopTest::reset(const FiberAssembly& fibers) {
  fibers_ = &fibers;
  if (slots_.size() != fibers.fiber_count()) {
    slots_ = std::vector<Slot>(fibers.fiber_count());
  }
  most_points_ = 0;
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    most_points_ = std::max(most_points_, fibers.offsets()[fiber + 1] - fibers.offsets()[fiber]);
    slots_[fiber].is_filled.store(false, std::memory_order_relaxed);
  }
}

std::size_t LoopTest::memory_bytes() const {
  const std::lock_guard lock(mutex_);
  std::size_t bytes = slots_.capacity() * sizeof(Slot);
  for (const Slot& slot : slots_) {
    if (slot.chain != nullptr) {
      bytes +=
          sizeof(Chain) + slot.chain->stretches.memory_bytes() + slot.chain->boxes.memory_bytes();
    }
  }
  return bytes;
}

const LoopTest::Chain& LoopTest::chain(std::uint32_t fiber) const {
  Slot& slot = slots_[fiber];
  if (!slot.is_filled.load(std::memory_order_acquire)) {
    const std::lock_guard lock(mutex_);
    if (!slot.is_filled.load(std::memory_order_relaxed)) {
      if (slot.chain == nullptr) {
        slot.chain = std::make_unique<Chain>();
      }
      slot.chain->fit(*fibers_, fiber);
      slot.is_filled.store(true, std::memory_order_release);
    }
  }
  return *slot.chain;
}

LoopTest::Place LoopTest::place(std::uint32_t segment, double s) const {
  const Vector3d& p0 = fibers_->points()[segment];
  const Vector3d& p1 = fibers_->points()[segment + 1];
  return s <= 0.5 ? Place{p0, s * (p1 - p0)} : Place{p1, (1.0 - s) * (p0 - p1)};
}

/// Whether a point between the segments is further from the place than the limit [m]. As many
/// points are left out each time as it takes at least to get there, or as are in a box that is not
/// further: a fibre may stay near one place for a million points.
bool LoopTest::leaves(const Place& place, PointPair pair, double limit,
                      std::uint64_t& looks) const {
  const double scale = limit > least_safe_norm ? 1.0 : tiny_vector_scale;
  const double scaled_limit = scale * limit;
  const std::vector<Vector3d>& points = fibers_->points();
  const bool is_long = pair.b - pair.a > short_walk;
  const Chain* const along = is_long ? &chain(fibers_->segment_id(pair.a).fiber) : nullptr;
  const double step = is_long ? scale * along->step : 0.0;
  const auto way_to = [&](const Vector3d& point) -> Vector3d {
    return scale * ((point - place.end) - place.way);
  };
  const auto is_within = [&](const Eigen::AlignedBox3d& box) {
    // Sums and products are monotonic, roundings included: of no point more comes out.
    const Vector3d most = way_to(box.min()).cwiseAbs().cwiseMax(way_to(box.max()).cwiseAbs());
    return most.squaredNorm() <= scaled_limit * scaled_limit;
  };
  for (std::uint32_t k = pair.a + 1; k <= pair.b; ++k) {
    ++looks;
    const double squared = way_to(points[k]).squaredNorm();
    if (squared > scaled_limit * scaled_limit) {
      return true;
    }
    if (is_long) {
      if (const std::uint32_t count = along->boxes.count_within(k, pair.b, is_within)) {
        k += count - 1;
        continue;
      }
      const double rest = (1.0 - 0x1p-40) * scaled_limit - std::sqrt(squared);
      if (rest >= step * (pair.b - k)) {
        return false;
      }
      k += rest > 0.0 ? static_cast<std::uint32_t>(rest / step) : 0;
    }
  }
  return false;
}

bool LoopTest::makes_loop(PointPair pair, const SegmentDistance& nearest,
                          std::uint64_t& looks) const {
  if (pair.b - pair.a > short_walk && rules_out(pair.a, pair.b)) {
    return false;
  }
  const std::vector<Vector3d>& points = fibers_->points();
  const double radius = std::max(fibers_->segment_radius(pair.a), fibers_->segment_radius(pair.b));
  const double length_a = norm_of(points[pair.a + 1] - points[pair.a]);
  const double length_b = norm_of(points[pair.b + 1] - points[pair.b]);
  // What places on segments are rounded by makes no loop.
  const double allowance = count_of_radii * radius + 0x1p-48 * (length_a + length_b);
  const auto limit = [&](double distance) { return part_of_distance * distance + allowance; };
  const auto is_left = [&](const Place& x, const Place& y, double from_either) {
    return leaves(x, pair, from_either, looks) || leaves(y, pair, from_either, looks);
  };
  const Place a = place(pair.a, nearest.s);
  const Place b = place(pair.b, nearest.t);
  const double nearest_limit = limit(nearest.distance);
  // Other places on the segments are no further from these than the longer segment.
  const double limit_for_all = nearest_limit - std::max(length_a, length_b);
  if (limit_for_all > 0.0 && !is_left(a, b, limit_for_all)) {
    return false;
  }
  if (is_left(a, b, nearest_limit)) {
    return true;
  }
  const double most = nearest.distance + radius;
  const Vector3d& outer_a = points[pair.a];
  const Vector3d& outer_b = points[pair.b + 1];
  const SegmentDistance of_a =
      segment_distance(outer_a, outer_a, points[pair.b], points[pair.b + 1]);
  if (of_a.distance <= most &&
      is_left(place(pair.a, 0.0), place(pair.b, of_a.t), limit(of_a.distance))) {
    return true;
  }
  const SegmentDistance of_b =
      segment_distance(points[pair.a], points[pair.a + 1], outer_b, outer_b);
  return of_b.distance <= most &&
         is_left(place(pair.a, of_b.s), place(pair.b, 1.0), limit(of_b.distance));
}

bool LoopTest::rules_out(std::uint32_t first, std::uint32_t last) const {
  if (last - first >= most_points_) {
    return false;
  }
  const std::uint32_t fiber = fibers_->segment_id(first).fiber;
  return is_within(fiber, last) && chain(fiber).stretches.hold(first, last + 1);
}

PointRange LoopTest::ruled_out_with(std::uint32_t point) const {
  return chain(fibers_->segment_id(point).fiber).stretches.around(point);
}

}  // namespace fiber

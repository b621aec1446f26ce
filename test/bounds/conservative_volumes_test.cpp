// Volumes around what is hard to bound never miss it, judged by exact distances.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "src/paper/bounds/sphere.hpp"
#include "test/support/bounding_volumes.hpp"
#include "test/support/hard_runs.hpp"
#include "test/support/not_finite.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"
#include "test/support/seeded_test.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;
using Capsules = std::vector<Capsule>;

/// Where contents are.
struct Place {
  double scale;  // [m]
  double away;   // [m] from the origin
  bool local;    // relative to an origin of their own, as the hierarchies have it
};

constexpr Place places[] = {{1.0, 0.0, false},  {1e-3, 0.0, false}, {1e-3, 1e6, false},
                            {1e-3, 1e8, false}, {1e-3, 1e6, true},  {1e-3, 1e8, true}};

void move(Capsules& run, const Vector3d& by) {
  for (Capsule& capsule : run) {
    capsule.p0 += by;
    capsule.p1 += by;
  }
}

/// The two capsules that seem nearest.
struct NearestPair {
  Capsule a;
  Capsule b;
  SegmentDistance found;
};

NearestPair nearest_pair(const HardRuns& runs) {
  NearestPair nearest;
  double least = infinity;
  for (const Capsule& a : runs.a) {
    for (const Capsule& b : runs.b) {
      const SegmentDistance found = segment_distance(a.p0, a.p1, b.p0, b.p1);
      const double gap = found.distance - (a.radius + b.radius);
      if (gap < least) {
        least = gap;
        nearest = {a, b, found};
      }
    }
  }
  return nearest;
}

/// [m] The contents come at least so near to each other; exact, rounded up.
double exact_gap(const HardRuns& runs) {
  const auto& [a, b, found] = nearest_pair(runs);
  const double distance = exact_segment_distance(a.p0, a.p1, b.p0, b.p1).upper();
  const double radii = std::nextafter(a.radius + b.radius, 0.0);
  return std::max(0.0, std::nextafter(distance - radii, infinity));
}

void set_radii(HardRuns& runs, Random& random) {
  const int kind = random.integer(0, 2);  // none, one for all, any
  const double shared = std::pow(10.0, random.uniform(-8.0, 0.0));
  for (Capsules* run : {&runs.a, &runs.b}) {
    for (Capsule& capsule : *run) {
      capsule.radius = kind == 0 ? 0.0 : shared * (kind == 1 ? 1.0 : random.uniform(0.0, 1.0));
    }
  }
}

/// Moves b until they just touch, or stay a little apart.
void bring_together(HardRuns& runs, Random& random) {
  const NearestPair nearest = nearest_pair(runs);
  const double distance = nearest.found.distance;
  if (distance > 0.0) {
    const double apart = nearest.a.radius + nearest.b.radius + tiny(random);
    move(runs.b, nearest.found.delta * ((apart - distance) / distance));
  }
}

HardRuns make(const RunFamily& family, const Place& place, Random& random) {
  HardRuns runs = family.make(random);
  set_radii(runs, random);
  bring_together(runs, random);
  const Vector3d shift = place.away * random.direction();
  for (Capsules* run : {&runs.a, &runs.b}) {
    for (Capsule& capsule : *run) {
      capsule = {place.scale * capsule.p0, place.scale * capsule.p1, place.scale * capsule.radius};
    }
    move(*run, shift);
  }
  if (place.local) {
    const Vector3d origin = runs.a.front().p0;
    move(runs.a, -origin);
    move(runs.b, -origin);
  }
  return runs;
}

/// Of a run as the layered hierarchies make it: leaves, then neighbours, then the rest.
template <class Volume>
Volume merged(const Capsules& run, std::size_t begin, std::size_t end) {
  const std::size_t middle = (begin + end + 1) / 2;
  if (end - begin == 1) {
    return fitted<Volume>(run[begin]);
  }
  if (end - begin == 2) {
    return merge_leaves(fitted<Volume>(run[begin]), fitted<Volume>(run[begin + 1]), run[begin],
                        run[begin + 1]);
  }
  return merge(merged<Volume>(run, begin, middle), merged<Volume>(run, middle, end));
}

/// A run's volumes, made in all ways there are.
template <class Volume>
std::vector<Volume> volumes(const Capsules& run) {
  auto one_by_one = fitted<Volume>(run.front());
  for (const Capsule& capsule : run) {
    one_by_one = merge(one_by_one, fitted<Volume>(capsule));
  }
  return {fitted<Volume>(run), merged<Volume>(run, 0, run.size()), one_by_one};
}

template <class Volume>
class ConservativeVolumesTest : public testing::Test {
 protected:
  /// Calls with contents of every family at every place.
  template <class Check>
  void for_all(const Check& check) {
    SCOPED_TRACE(seed_message());
    Random random;
    for (const RunFamily& family : run_families()) {
      for (const Place& place : places) {
        SCOPED_TRACE(family.name + " of " + std::to_string(place.scale) + " m at " +
                     std::to_string(place.away) + " m" + (place.local ? ", local" : ""));
        for (int round = 0; round < rounds(300) && !this->HasFatalFailure(); ++round) {
          check(make(family, place, random));
        }
      }
    }
  }
};

TYPED_TEST_SUITE(ConservativeVolumesTest, VolumeTypes);

TYPED_TEST(ConservativeVolumesTest, HoldAllTheirCapsules) {
  this->for_all([](const HardRuns& runs) {
    for (const Capsules* run : {&runs.a, &runs.b}) {
      for (const TypeParam& volume : volumes<TypeParam>(*run)) {
        for (const Capsule& capsule : *run) {
          ASSERT_TRUE(contains(volume, capsule, parameters<TypeParam>()));
          ASSERT_TRUE(overlaps(volume, fitted<TypeParam>(capsule), 0.0F));
          ASSERT_LE(distance_lower_bound(volume, fitted<TypeParam>(capsule)), 0.0F);
        }
      }
    }
  });
}

TYPED_TEST(ConservativeVolumesTest, NeverMissWhatComesWithinTheMargin) {
  this->for_all([](const HardRuns& runs) {
    const double gap = exact_gap(runs);
    for (const TypeParam& a : volumes<TypeParam>(runs.a)) {
      for (const TypeParam& b : volumes<TypeParam>(runs.b)) {
        ASSERT_TRUE(overlaps(a, b, round_up(gap))) << gap;
        ASSERT_TRUE(overlaps(b, a, round_up(gap))) << gap;
      }
    }
  });
}

TYPED_TEST(ConservativeVolumesTest, AreNoFartherApartThanWhatTheyHold) {
  this->for_all([](const HardRuns& runs) {
    const double gap = exact_gap(runs);
    for (const TypeParam& a : volumes<TypeParam>(runs.a)) {
      for (const TypeParam& b : volumes<TypeParam>(runs.b)) {
        ASSERT_LE(static_cast<double>(distance_lower_bound(a, b)), gap);
        ASSERT_LE(static_cast<double>(distance_lower_bound(b, a)), gap);
      }
    }
  });
}

/// All points are in the sphere, and it is no larger than one that holds them.
void expect_minimal(const std::vector<Vector3d>& points, double enough) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  const MinimalSphere sphere = minimal_sphere(points, order);
  for (const Vector3d& point : points) {
    ASSERT_LE((point - sphere.center).squaredNorm(), sphere.squared_radius);
  }
  ASSERT_LE(std::sqrt(sphere.squared_radius), enough * (1.0 + 1e-9));
}

class MinimalSphereTest : public SeededTest {};

TEST_P(MinimalSphereTest, OfCosphericalPointsIsNoLargerThanTheirs) {
  SCOPED_TRACE(seed_message());
  Random random(seed(), 0);
  for (int round = 0; round < rounds(5000); ++round) {
    const Cospherical sphere = cospherical(random);
    expect_minimal(sphere.points, sphere.radius);
  }
}

TEST_P(MinimalSphereTest, OfCoincidentAndCollinearPointsIsTheirSpan) {
  SCOPED_TRACE(seed_message());
  Random random(seed(), 0);
  for (int round = 0; round < rounds(5000); ++round) {
    const Vector3d p = random.in_cube();
    const Vector3d u = random.direction();
    const double off = tiny(random);
    std::vector<Vector3d> points;
    for (int i = 0; i < 12; ++i) {
      const double along = random.chance(0.3) ? 1.0 : random.uniform(-1.0, 1.0);
      points.emplace_back(p + (random.chance(0.5) ? off : 1.0) * along * u);
    }
    double low = infinity;
    double high = -infinity;
    for (const Vector3d& point : points) {
      low = std::min(low, u.dot(point - p));
      high = std::max(high, u.dot(point - p));
    }
    expect_minimal(points, 0.5 * (high - low) + 1e-15);
  }
}

// Four points nearly in a plane: their sphere was too large by 3e-9.
INSTANTIATE_TEST_SUITE_P(Seeds, MinimalSphereTest, run_seed_and({391614154}), name_of_seed);

// Points in order along a line or an arc, as fibres have them: quadratic time would take hours.
TEST(MinimalSphereTest, OfManyPointsInOrderTakesLinearTime) {
  constexpr int count = 1'000'000;
  std::vector<Vector3d> line;
  std::vector<Vector3d> arc;
  for (int i = 0; i < count; ++i) {
    const double angle = M_PI * i / (count - 1);
    line.emplace_back(i, 0.0, 0.0);
    arc.emplace_back(std::cos(angle), std::sin(angle), 0.0);
  }
  expect_minimal(line, 0.5 * (count - 1));
  expect_minimal(arc, 1.0);
}

// With axes that are off by an angle the box around a line is as much too thick.
TEST(ObbTest, OfCollinearPointsIsThin) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < rounds(2000); ++round) {
    const Vector3d u = random.direction();
    Capsules run;
    for (int i = 0; i < 5; ++i) {
      run.push_back({random.uniform(-1.0, 1.0) * u, random.uniform(-1.0, 1.0) * u, 0.0});
    }
    const auto box = fitted<Obb>(run);
    ASSERT_LT(box.half_extents.minCoeff(), 4e-6F);
    ASSERT_LT(box.half_extents.sum() - box.half_extents.maxCoeff(), 8e-6F);
  }
}

}  // namespace
}  // namespace fiber::test

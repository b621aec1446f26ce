#include "fiber_proximity/query/for_engines/pair_collector.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"
#include "test/support/error_of.hpp"
#include "test/support/exact_distance.hpp"
#include "test/support/not_finite.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// Two cables of radius 0.1 crossing at right angles, 0.3 between their axes, on z.
FiberAssembly crossing() {
  return {{{-1, 0, 0}, {1, 0, 0}, {0, -1, 0.3}, {0, 1, 0.3}}, {0, 2, 4}, {0.1}};
}

TEST(PairCollector, DescribesAContact) {
  const QueryResult result = brute_force(crossing(), within(0.2));
  ASSERT_EQ(result.contacts.size(), 1U);
  const Contact& contact = result.contacts.front();
  EXPECT_EQ(contact.fiber_a, 0U);
  EXPECT_EQ(contact.fiber_b, 1U);
  EXPECT_EQ(contact.s, 0.5);
  EXPECT_EQ(contact.t, 0.5);
  EXPECT_NEAR(contact.distance, 0.1, 1e-15);
  EXPECT_TRUE(contact.normal.isApprox(Vector3d(0, 0, 1)));
  EXPECT_TRUE(contact.point_a.isApprox(Vector3d(0, 0, 0.1)));
  EXPECT_TRUE(contact.point_b.isApprox(Vector3d(0, 0, 0.2)));
  EXPECT_FALSE(result.limit_reached);
}

TEST(PairCollector, TakesTheMarginAsInclusive) {
  const FiberAssembly fibers({{-1, 0, 0}, {1, 0, 0}, {0, -1, 0.5}, {0, 1, 0.5}}, {0, 2, 4},
                             {0.125});
  EXPECT_EQ(brute_force(fibers, within(0.25)).contacts.size(), 1U);
  EXPECT_TRUE(brute_force(fibers, within(std::nextafter(0.25, 0.0))).contacts.empty());
}

TEST(PairCollector, LeavesOutPairsOfTheOtherPairing) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const AssemblyFamily& family : assembly_families()) {
    const FiberAssembly fibers = family.make(random);
    QueryOptions options = within(infinity);
    const QueryResult all = brute_force(fibers, options);
    options.pairing = Pairing::SAME_FIBER;
    const QueryResult same = brute_force(fibers, options);
    options.pairing = Pairing::DIFFERENT_FIBERS;
    const QueryResult different = brute_force(fibers, options);
    EXPECT_EQ(same.contacts.size() + different.contacts.size(), all.contacts.size());
    for (const Contact& contact : same.contacts) {
      ASSERT_EQ(contact.fiber_a, contact.fiber_b);
    }
    for (const Contact& contact : different.contacts) {
      ASSERT_NE(contact.fiber_a, contact.fiber_b);
    }
  }
}

TEST(PairCollector, PointsAndNormalAgreeWithTheDistanceEvenInPenetration) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const AssemblyFamily& family : assembly_families()) {
    if (family.name == "denormal") {
      continue;  // a unit normal times a denormal keeps no digits
    }
    SCOPED_TRACE(family.name);
    QueryOptions options = within(infinity);
    options.neighbour_skip = 0;
    const FiberAssembly fibers = family.make(random);
    double size = 0.0;
    for (const Vector3d& point : fibers.points()) {
      size = std::max(size, point.cwiseAbs().maxCoeff());
    }
    for (const Contact& contact : brute_force(fibers, options).contacts) {
      ASSERT_NEAR(contact.normal.norm(), 1.0, 1e-14);
      const double tolerance = 1e-14 * (size + fibers.radii().front() + std::abs(contact.distance));
      ASSERT_NEAR((contact.point_b - contact.point_a).dot(contact.normal), contact.distance,
                  tolerance);
    }
  }
}

TEST(PairCollector, GapIsTheExactDistanceLessTheRadii) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = assembly_families()[2].make(random);
  for (const Contact& contact : brute_force(fibers, within(infinity)).contacts) {
    const Capsule a = fibers.capsule(fibers.offsets()[contact.fiber_a] + contact.segment_a);
    const Capsule b = fibers.capsule(fibers.offsets()[contact.fiber_b] + contact.segment_b);
    const double exact =
        static_cast<double>(exact_distance(a.p0, a.p1, b.p0, b.p1) - a.radius - b.radius);
    ASSERT_NEAR(contact.distance, exact, 1e-14);
  }
}

TEST(PairCollector, SkipsNeighboursByIndex) {
  std::vector<Vector3d> points;
  for (int i = 0; i < 6; ++i) {
    points.emplace_back(i, 0, 0);
  }
  const FiberAssembly fibers(points, {0, 6}, {10.0});  // five segments, all overlapping
  QueryOptions options;
  for (const auto& [skip, pairs] : {std::pair{0U, 10U}, {1U, 6U}, {2U, 3U}, {3U, 1U}, {4U, 0U}}) {
    options.neighbour_skip = skip;
    EXPECT_EQ(brute_force(fibers, options).contacts.size(), pairs) << "skip " << skip;
  }
}

TEST(PairCollector, SkipsNeighboursByArcLengthOnTheirFiberOnly) {
  std::vector<Vector3d> points;
  for (int i = 0; i < 6; ++i) {
    points.emplace_back(i, 0, 0);
  }
  QueryOptions options;
  options.neighbour_skip_length = 2.0;  // between segments i and i + 3 lie 2 m: not less
  EXPECT_EQ(brute_force(FiberAssembly(points, {0, 6}, {10.0}), options).contacts.size(), 3U);
  // The same points as two fibres: three pairs on neither, six across.
  EXPECT_EQ(brute_force(FiberAssembly(points, {0, 3, 6}, {10.0}), options).contacts.size(), 4U);
}

/// Lengths whose squares underflow are lengths.
TEST(PairCollector, SkipsNeighboursByArcLengthAtEveryScale) {
  std::vector<Vector3d> line;
  for (int i = 0; i < 6; ++i) {
    line.emplace_back(i, 2 * i, -2 * i);  // 3 apart
  }
  for (const int exponent : {-1070, -1040, -600, -565, -500, -300, 0, 300, 490}) {
    const double scale = std::ldexp(1.0, exponent);
    std::vector<Vector3d> points = line;
    for (Vector3d& point : points) {
      point *= scale;
    }
    const FiberAssembly fibers(points, {0, 6}, {10.0 * scale});
    QueryOptions options;
    for (const auto& [length, pairs] :
         {std::pair{3.0, 6U}, {4.0, 3U}, {6.0, 3U}, {7.0, 1U}, {9.0, 1U}, {10.0, 0U}}) {
      options.neighbour_skip_length = length * scale;
      EXPECT_EQ(brute_force(fibers, options).contacts.size(), pairs)
          << length << " of 3, times 2^" << exponent;
    }
  }
}

TEST(PairCollector, NormalsOfSubnormalGapsAreOfUnitLength) {
  constexpr double least = std::numeric_limits<double>::denorm_min();
  const QueryOptions options = within(1.0);
  for (const Vector3d& gap : {Vector3d(1, 1, 0), Vector3d(1, 1, -1), Vector3d(3, -4, 0),
                              Vector3d(0, 0, 1), Vector3d(1e9, 2e9, -2e9)}) {
    // Two points beside each other.
    const Vector3d q = least * gap;
    const FiberAssembly fibers({Vector3d::Zero(), Vector3d::Zero(), q, q}, {0, 2, 4}, {0.0});
    const QueryResult found = brute_force(fibers, options);
    ASSERT_EQ(found.contacts.size(), 1U);
    EXPECT_NEAR((found.contacts[0].normal - gap.normalized()).norm(), 0.0, 1e-15) << gap;
  }
  // Segments that meet, as short as can be: at right angles to both.
  const Vector3d u(least, 0, 0);
  const Vector3d v(0, least, 0);
  const FiberAssembly crossed({-u, u, -v, v}, {0, 2, 4}, {0.0});
  const QueryResult found = brute_force(crossed, options);
  ASSERT_EQ(found.contacts.size(), 1U);
  EXPECT_NEAR(found.contacts[0].normal.cwiseAbs().z(), 1.0, 1e-15);
}

TEST(PairCollector, KeepsTheClosestSortedByIndex) {
  const FiberAssembly fibers = as_fibers({{{0, 0, 0}, {1, 0, 0}},
                                          {{0, 0, 1}, {1, 0, 1}},
                                          {{0, 0, 1.5}, {1, 0, 1.5}},
                                          {{0, 0, 3}, {1, 0, 3}}});
  QueryOptions options = within(10.0, QueryType::LIMITED);
  options.max_contacts = 2;
  const QueryResult two = brute_force(fibers, options);
  ASSERT_EQ(two.contacts.size(), 2U);
  EXPECT_TRUE(two.limit_reached);
  EXPECT_EQ(two.contacts[0].fiber_a, 0U);  // 0–1 at 1.0
  EXPECT_EQ(two.contacts[1].fiber_a, 1U);  // 1–2 at 0.5
  EXPECT_EQ(two.closest()->fiber_a, 1U);
  options.type = QueryType::CLOSEST;
  const QueryResult one = brute_force(fibers, options);
  ASSERT_EQ(one.contacts.size(), 1U);
  EXPECT_EQ(one.contacts[0].distance, 0.5);
  EXPECT_FALSE(one.limit_reached);
  options.margin = 0.4;
  EXPECT_TRUE(brute_force(fibers, options).contacts.empty());
}

TEST(QueryOptions, AreValidated) {
  const auto refusal = [](const QueryOptions& options) {
    return error_of([&] { validate(options); });
  };
  QueryOptions options;
  EXPECT_EQ(refusal(options), "no error");
  options.margin = -1.0;
  EXPECT_EQ(refusal(options),
            "margin is -1.000000, it must be at least 0 m (infinity for no limit)");
  options.margin = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal(options).find("margin is nan"), std::string::npos);
  options.margin = 0.0;
  options.neighbour_skip_length = -2.0;
  EXPECT_NE(refusal(options).find("neighbour_skip_length is -2"), std::string::npos);
  options.neighbour_skip_length = 0.0;
  options.max_contacts = 0;
  EXPECT_EQ(refusal(options), "no error");
  options.type = QueryType::LIMITED;
  EXPECT_NE(refusal(options).find("max_contacts is 0"), std::string::npos);
}

TEST(QueryType, HasANameForEach) {
  EXPECT_EQ(query_type_from_name("first"), QueryType::FIRST);
  EXPECT_EQ(query_type_from_name("closest"), QueryType::CLOSEST);
  EXPECT_EQ(query_type_from_name("limited"), QueryType::LIMITED);
  EXPECT_EQ(query_type_from_name("all"), QueryType::ALL);
  EXPECT_EQ(query_type_from_name("fiber_pairs"), QueryType::FIBER_PAIRS);
  EXPECT_THROW(query_type_from_name("any"), std::invalid_argument);
}

}  // namespace
}  // namespace fiber::test

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "fiber_proximity/query/engine.hpp"
#include "src/query/brute_force.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"
#include "test/support/engines_test.hpp"
#include "test/support/error_of.hpp"
#include "test/support/random.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;
using Vector3l = Eigen::Matrix<long double, 3, 1>;

/// [m] From a point to the surface of a capsule.
long double distance(const Vector3d& point, const Capsule& capsule) {
  const Vector3l axis = (capsule.p1 - capsule.p0).cast<long double>();
  const Vector3l offset = point.cast<long double>() - capsule.p0.cast<long double>();
  const long double squared = axis.squaredNorm();
  const long double s = squared > 0.0L ? std::clamp(offset.dot(axis) / squared, 0.0L, 1.0L) : 0.0L;
  return (offset - s * axis).norm() - static_cast<long double>(capsule.radius);
}

/// [m] Of all segments, sorted.
std::vector<long double> distances(const Vector3d& point, const FiberAssembly& fibers) {
  std::vector<long double> all;
  for (const std::uint32_t segment : segments_of(fibers)) {
    all.push_back(distance(point, fibers.capsule(segment)));
  }
  std::sort(all.begin(), all.end());
  return all;
}

class NearestSegmentsTest : public testing::TestWithParam<std::string> {
 protected:
  FiberAssembly make(const AssemblyFamily& family, Random& random) const {
    FiberAssembly fibers = family.make(random);
    return GetParam() == "AL-threaded" ? equal_fibers(fibers) : fibers;
  }

  std::unique_ptr<ProximityEngine> engine_ = make_engine(GetParam());
  QueryResult found_;
};

/// A point near the fibres, in them, or far from them.
Vector3d point_about(const FiberAssembly& fibers, Random& random) {
  if (fibers.point_count() == 0) {
    return random.in_cube();
  }
  const auto pick = [&] {
    return fibers.points()[static_cast<std::size_t>(
        random.integer(0, static_cast<int>(fibers.point_count()) - 1))];
  };
  const Vector3d at = pick();
  return at + random.uniform(0.0, 1.0) * (random.chance(0.2) ? 100.0 : 1.0) * (pick() - at);
}

TEST_P(NearestSegmentsTest, AreTheNearestOfAllOnEveryFamily) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const AssemblyFamily& family : sampled(assembly_families(), random)) {
    SCOPED_TRACE(family.name);
    const FiberAssembly fibers = make(family, random);
    engine_->update(fibers);
    for (int round = 0; round < 10; ++round) {
      const Vector3d point = point_about(fibers, random);
      const auto k = static_cast<std::uint32_t>(random.chance(0.1) ? 1000 : random.integer(1, 12));
      nearest_segments(*engine_, point, k, found_);
      const std::vector<long double> all = distances(point, fibers);
      ASSERT_EQ(found_.contacts.size(), std::min<std::size_t>(k, all.size()));
      EXPECT_EQ(found_.limit_reached, k <= all.size());
      for (std::size_t i = 0; i < found_.contacts.size(); ++i) {
        const Contact& contact = found_.contacts[i];
        const Capsule segment =
            fibers.capsule(fibers.offsets()[contact.fiber_b] + contact.segment_b);
        const double size = std::max((segment.p0 - point).cwiseAbs().maxCoeff(),
                                     (segment.p1 - point).cwiseAbs().maxCoeff());
        const double tolerance =
            1e-14 * (size + segment.radius) + std::numeric_limits<double>::min() * 1e-10;
        ASSERT_NEAR(contact.distance, static_cast<double>(all[i]), tolerance) << "rank " << i;
        ASSERT_NEAR(contact.distance, static_cast<double>(distance(point, segment)), tolerance);
        EXPECT_EQ(contact.point_a, point);
        EXPECT_EQ(contact.fiber_a, 0U);
        EXPECT_EQ(contact.segment_a, 0U);
        EXPECT_EQ(contact.s, 0.0);
        if (i > 0) {
          ASSERT_TRUE(found_.contacts[i - 1].closer_than(contact)) << "rank " << i;
        }
      }
    }
  }
}

TEST_P(NearestSegmentsTest, AreBruteForcesToTheBit) {
  SCOPED_TRACE(seed_message());
  Random random;
  BruteForceEngine oracle;
  QueryResult expected;
  for (const AssemblyFamily& family : sampled(assembly_families(), random)) {
    SCOPED_TRACE(family.name);
    const FiberAssembly fibers = make(family, random);
    engine_->update(fibers);
    oracle.update(fibers);
    for (std::uint32_t k = 1; k < 20; k += 3) {
      const Vector3d point = point_about(fibers, random);
      nearest_segments(*engine_, point, k, found_);
      nearest_segments(oracle, point, k, expected);
      ASSERT_TRUE(same_contacts(found_.contacts, expected.contacts));
    }
  }
}

// Without a margin nothing is too far: what the tree finds first must make the bound small.
TEST(NearestSegmentsOfRunTree, LookAtFewSegments) {
  Random random(1);
  const FiberAssembly fibers = walks(random, 100, 100, 0.01, 0.001);
  const auto engine = make_engine("run_tree");
  engine->update(fibers);
  QueryResult found;
  std::uint64_t tests = 0;
  for (int i = 0; i < 100; ++i) {
    nearest_segments(*engine, random.in_cube(), 1, found);
    ASSERT_EQ(found.contacts.size(), 1U);
    tests += found.counts.primitive_tests;
  }
  EXPECT_GT(tests, 100U);
  EXPECT_LT(tests, 100U * fibers.segment_count() / 50);
}

INSTANTIATE_TEST_SUITE_P(Engines, NearestSegmentsTest, all_engines(), name_of_engine);

// Three fibres along x at heights 0, 1 and 3; the point is in the axis of the second.
TEST(NearestSegments, AreSortedByDistanceThenByIndex) {
  const FiberAssembly fibers(
      {{-1, 0, 0}, {1, 0, 0}, {-1, 0, 1}, {0, 0, 1}, {1, 0, 1}, {-1, 0, 3}, {1, 0, 3}},
      {0, 2, 5, 7}, {0.25});
  const auto engine = make_engine("run_tree");
  engine->update(fibers);
  QueryResult result;
  nearest_segments(*engine, {0, 0, 1}, 3, result);
  ASSERT_EQ(result.contacts.size(), 3U);
  EXPECT_TRUE(result.limit_reached);
  EXPECT_EQ(result.contacts[0].key(), std::make_tuple(0U, 0U, 1U, 0U));
  EXPECT_EQ(result.contacts[0].distance, -0.25);
  EXPECT_EQ(result.contacts[1].key(), std::make_tuple(0U, 0U, 1U, 1U));
  EXPECT_EQ(result.contacts[1].distance, -0.25);
  EXPECT_EQ(result.contacts[2].key(), std::make_tuple(0U, 0U, 0U, 0U));
  EXPECT_EQ(result.contacts[2].distance, 0.75);
  EXPECT_EQ(result.contacts[2].t, 0.5);
  EXPECT_EQ(result.contacts[2].point_b, Vector3d(0, 0, 0.25));
  EXPECT_EQ(result.contacts[2].normal, Vector3d(0, 0, -1));
}

TEST(NearestSegments, RefuseWhatTheyCannotAnswer) {
  const FiberAssembly fibers({{0, 0, 0}, {1, 0, 0}}, {0, 2}, {0.1});
  const auto engine = make_engine("run_tree");
  QueryResult result;
  EXPECT_THROW(nearest_segments(*engine, {0, 0, 0}, 1, result), std::logic_error);
  engine->update(fibers);
  const auto refusal = [&](const Vector3d& point, std::uint32_t k) {
    return error_of([&] { nearest_segments(*engine, point, k, result); });
  };
  const std::string rule = ", coordinates must be finite and at most 1e150 m in magnitude";
  EXPECT_EQ(refusal({0, 0, 0}, 1), "no error");
  EXPECT_EQ(refusal({0, 0, 0}, 0), "k is 0, it must be at least 1");
  EXPECT_EQ(refusal({0, std::nan(""), 0}, 1), "point: y is nan" + rule);
  EXPECT_EQ(refusal({std::numeric_limits<double>::infinity(), 0, 0}, 1), "point: x is inf" + rule);
  EXPECT_EQ(refusal({0, 0, -1e200}, 1), "point: z is -1e+200" + rule);
}

}  // namespace
}  // namespace fiber::test

#include "fiber_proximity/environment/environment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "src/environment/convex_solids.hpp"
#include "test/environment/environment_queries.hpp"
#include "test/support/error_of.hpp"
#include "test/support/not_finite.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

TEST(Environment, ReportsWhatBruteForceReports) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const double extent : {1e-3, 1.0, 1e3}) {
    for (int round = 0; round < 10; ++round) {
      const std::vector<EnvironmentObject> objects = random_objects(random, extent);
      const Environment environment(objects);
      const FiberAssembly fibers = random_fibers(random, extent);
      const std::vector<Contact> pairs = all_pairs(fibers, objects);
      for (const QueryType type :
           {QueryType::CLOSEST, QueryType::LIMITED, QueryType::ALL, QueryType::FIBER_PAIRS}) {
        for (const double margin : {0.0, 0.1 * extent, infinity}) {
          QueryOptions options;
          options.type = type;
          options.margin = margin;
          options.max_contacts = 7;
          const QueryResult result = ask(environment, fibers, options);
          const std::vector<Contact> wanted = expected(pairs, options);
          ASSERT_EQ(result.contacts.size(), wanted.size()) << static_cast<int>(type) << margin;
          for (std::size_t i = 0; i < wanted.size(); ++i) {
            ASSERT_EQ(result.contacts[i].key(), wanted[i].key()) << static_cast<int>(type);
            ASSERT_NEAR(result.contacts[i].distance, wanted[i].distance, 1e-13 * extent);
          }
        }
      }
    }
  }
}

TEST(Environment, PointsNormalDistanceAndBoundsAgree) {
  SCOPED_TRACE(seed_message());
  Random random;
  const std::vector<EnvironmentObject> objects = random_objects(random, 1.0);
  const Environment environment(objects);
  const FiberAssembly fibers = random_fibers(random, 1.0);
  QueryOptions options;
  options.margin = infinity;
  const QueryResult result = ask(environment, fibers, options);
  ASSERT_FALSE(result.contacts.empty());
  for (const Contact& contact : result.contacts) {
    EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-12);
    EXPECT_NEAR((contact.point_b - contact.point_a).dot(contact.normal), contact.distance, 1e-12);
    const std::uint32_t first = fibers.offsets()[contact.fiber_a] + contact.segment_a;
    const Capsule capsule = fibers.capsule(first);
    const Vector3d on_axis = capsule.p0 + contact.s * (capsule.p1 - capsule.p0);
    EXPECT_NEAR((contact.point_a - on_axis).norm(), capsule.radius, 1e-12);
    const EnvironmentObject& object = objects[contact.fiber_b];
    const PlacedShape& placed = object.shapes[contact.segment_b];
    const Vector3d on_shape = (object.pose * placed.pose).inverse() * contact.point_b;
    EXPECT_LE(axis_distance(placed.shape, on_shape, on_shape, infinity).distance, 1e-12);
    EXPECT_LE(contact.lower, contact.distance);
    EXPECT_LT(contact.distance, contact.upper);
    EXPECT_LT(contact.upper - contact.distance, 1e-13);
  }
}

TEST(Environment, FirstIsOneOfTheContactsAndNoneWithoutAny) {
  SCOPED_TRACE(seed_message());
  Random random;
  QueryOptions options;
  options.type = QueryType::FIRST;
  for (int round = 0; round < 30; ++round) {
    const std::vector<EnvironmentObject> objects = random_objects(random, 1.0);
    const FiberAssembly fibers = random_fibers(random, 1.0);
    const std::vector<Contact> pairs = all_pairs(fibers, objects);
    const QueryResult result = ask(Environment(objects), fibers, options);
    const bool any = std::any_of(pairs.begin(), pairs.end(),
                                 [](const Contact& pair) { return pair.distance <= 0.0; });
    ASSERT_EQ(result.contacts.size(), any ? 1U : 0U);
    if (any) {
      EXPECT_LE(result.contacts.front().distance, 0.0);
    }
  }
}

TEST(Environment, NothingIsNearerThanTheOthersLowerBound) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < 20; ++round) {
    const std::vector<EnvironmentObject> objects = random_objects(random, 1.0);
    const Environment environment(objects);
    const FiberAssembly fibers = random_fibers(random, 1.0);
    const std::vector<Contact> pairs = all_pairs(fibers, objects);
    for (const QueryType type :
         {QueryType::CLOSEST, QueryType::LIMITED, QueryType::ALL, QueryType::FIBER_PAIRS}) {
      QueryOptions options;
      options.type = type;
      options.margin = random.chance(0.5) ? 0.05 : infinity;
      options.max_contacts = 3;
      const QueryResult result = ask(environment, fibers, options);
      for (const Contact& pair : pairs) {
        const bool reported =
            std::any_of(result.contacts.begin(), result.contacts.end(),
                        [&](const Contact& contact) { return contact.key() == pair.key(); });
        if (!reported) {
          ASSERT_GE(pair.distance, result.others_lower - 1e-13) << static_cast<int>(type);
        }
        ASSERT_GE(pair.distance, result.minimum_lower() - 1e-13);
      }
    }
  }
}

TEST(Environment, AFarUnboundedSolidIsFound) {
  const Environment environment(
      {{"floor", Eigen::Isometry3d::Identity(), {{HalfSpaceShape{Vector3d::UnitZ(), -1.0}}}}});
  const FiberAssembly fibers({{0, 0, 0}, {1000, 0, -0.75}}, {0, 2}, {0.125});
  QueryOptions options;
  options.margin = 0.125;
  const QueryResult result = ask(environment, fibers, options);
  ASSERT_EQ(result.contacts.size(), 1U);
  EXPECT_NEAR(result.contacts[0].distance, 0.125, 1e-12);
  EXPECT_EQ(result.contacts[0].s, 1.0);
  EXPECT_TRUE(result.contacts[0].normal.isApprox(Vector3d(0, 0, -1)));
}

TEST(Environment, AllowedPairsAreNoPairs) {
  EnvironmentObject gripper{"gripper", Eigen::Isometry3d::Identity(), {{SphereShape{10.0}}}};
  EnvironmentObject table = gripper;
  table.name = "table";
  const Environment environment({gripper, table});
  std::vector<Vector3d> points;
  for (int i = 0; i < 6; ++i) {
    points.emplace_back(0.1 * i, 0.0, 0.0);
  }
  points.insert(points.end(), points.begin(), points.end());
  const FiberAssembly fibers(points, {0, 6, 12}, {0.01});
  const auto count = [&](const AllowedPair& allowed) {
    return ask(environment, fibers, {}, {allowed}).contacts.size();
  };
  EXPECT_EQ(ask(environment, fibers, {}).contacts.size(), 20U);
  EXPECT_EQ(count({"gripper", 0, 0, 1}), 18U);
  EXPECT_EQ(count({"gripper", 0, -2, -1}), 18U);
  EXPECT_EQ(count({"gripper", 1, 0, -1}), 15U);
  EXPECT_EQ(count({"", 1, 0, -1}), 10U);
  EXPECT_EQ(count({"gripper", AllowedPair::every_fiber, 0, 0}), 18U);
  EXPECT_EQ(count({"chair", AllowedPair::every_fiber, 0, -1}), 20U);
  EXPECT_EQ(count({"", AllowedPair::every_fiber, 0, -1}), 0U);
}

TEST(Environment, OfManyAllowedPairsEachIsNone) {
  const std::vector<std::string> names{"", "gripper", "table", "chair"};
  const EnvironmentObject gripper{"gripper", Eigen::Isometry3d::Identity(), {{SphereShape{10.0}}}};
  EnvironmentObject table = gripper;
  table.name = "table";
  const Environment environment({gripper, table});
  std::vector<Vector3d> points;
  for (int i = 0; i < 3 * 9; ++i) {
    points.emplace_back(0.1 * (i % 9), 0.0, 0.0);
  }
  const FiberAssembly fibers(points, {0, 9, 18, 27}, {0.01});
  std::mt19937 random(11);
  for (int round = 0; round < 100; ++round) {
    AllowedPairs allowed;
    for (std::uint32_t i = 0; i < 1 + random() % 8; ++i) {
      const std::uint32_t fiber = random() % 4;
      allowed.push_back({names[random() % names.size()],
                         fiber < 3 ? fiber : AllowedPair::every_fiber,
                         static_cast<std::int64_t>(random() % 16) - 8,
                         static_cast<std::int64_t>(random() % 16) - 8});
    }
    std::set<std::tuple<std::uint32_t, std::int64_t, std::uint32_t>> expected;
    for (std::uint32_t fiber = 0; fiber < 3; ++fiber) {
      for (std::int64_t segment = 0; segment < 8; ++segment) {
        for (std::uint32_t object = 0; object < 2; ++object) {
          const bool is_allowed =
              std::any_of(allowed.begin(), allowed.end(), [&](const AllowedPair& pair) {
                const auto at = [](std::int64_t index) { return index < 0 ? 8 + index : index; };
                return (pair.object.empty() || pair.object == names[object + 1]) &&
                       (pair.fiber == AllowedPair::every_fiber || pair.fiber == fiber) &&
                       at(pair.first_segment) <= segment && segment <= at(pair.last_segment);
              });
          if (!is_allowed) {
            expected.emplace(fiber, segment, object);
          }
        }
      }
    }
    std::set<std::tuple<std::uint32_t, std::int64_t, std::uint32_t>> found;
    for (const Contact& contact : ask(environment, fibers, {}, allowed).contacts) {
      found.emplace(contact.fiber_a, contact.segment_a, contact.fiber_b);
    }
    ASSERT_EQ(found, expected) << "round " << round;
  }
}

TEST(Environment, NamesWhatItRefuses) {
  const auto refusal = [](const std::vector<EnvironmentObject>& objects) {
    return error_of([&] { const Environment environment(objects); });
  };
  const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
  Eigen::Isometry3d scaled = identity;
  scaled.linear() *= 2.0;
  Eigen::Isometry3d nowhere = identity;
  nowhere.translation().x() = std::nan("");
  EXPECT_EQ(refusal({{"table", identity, {{SphereShape{1.0}}}}}), "no error");
  EXPECT_EQ(refusal({{"", identity, {{SphereShape{1.0}}}}}), "an object has no name");
  EXPECT_EQ(
      refusal({{"table", identity, {{SphereShape{1.0}}, {SphereShape{-1.0}}}}}),
      "object 'table', shape 1: radius of the sphere is -1, it must be finite, at least 0 and "
      "at most 1e150 m");
  EXPECT_NE(refusal({{"table", scaled, {{SphereShape{1.0}}}}}).find("'table': the orientation"),
            std::string::npos);
  EXPECT_NE(refusal({{"table", nowhere, {{SphereShape{1.0}}}}}).find("'table': a coordinate"),
            std::string::npos);
  EXPECT_NE(refusal({{"floor", identity, {{PlaneShape{{0, 0, 2}, 0.0}}}}}).find("normal is 2"),
            std::string::npos);
  EXPECT_NE(refusal({{"mesh", identity, {{std::shared_ptr<const TriangleMesh>()}}}}).find("null"),
            std::string::npos);
  EXPECT_NE(refusal({{"a", identity, {}}, {"a", identity, {}}}).find("two objects of the name 'a'"),
            std::string::npos);
}

}  // namespace
}  // namespace fiber::test

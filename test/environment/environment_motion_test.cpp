// Fibres that move among objects that stand still or move: what is found is held against the
// distances at many times.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

#include "test/environment/motion_scene.hpp"
#include "test/support/not_finite.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;

/// How often what was seen.
struct Seen {
  int touching = 0;
  int certain = 0;
  int perhaps = 0;
  int without_upper = 0;
  int free = 0;
};

void expect_true_of_all_times(const MotionScene& scene, double extent, Seen& seen) {
  constexpr int times = 100;
  const double slack = 1e-12 * extent;
  const double margin = scene.options.margin;
  const MotionResult result = scene.ask();
  EXPECT_TRUE(result.complete);
  std::map<Key, MotionContact> found;
  for (const std::vector<MotionContact>* list : {&result.contacts, &result.touching}) {
    for (const MotionContact& contact : *list) {
      EXPECT_TRUE(found.emplace(contact.key(), contact).second);
    }
  }
  const auto segments = static_cast<std::uint32_t>(scene.fibers_before.segment_count());
  for (std::uint32_t segment = 0; segment < segments; ++segment) {
    for (std::uint32_t object = 0; object < scene.before.size(); ++object) {
      SCOPED_TRACE(scene.before[object].shapes[0].shape.index());
      const auto contact = found.find({0, segment, object, 0});
      const double lower = contact == found.end() ? infinity : contact->second.lower;
      for (int i = 0; i < times; ++i) {
        const double time = static_cast<double>(i) / (times - 1);
        if (time < lower) {
          ASSERT_GT(scene.gap(segment, object, time), margin - slack) << time << " " << lower;
        }
      }
      if (contact == found.end()) {
        ++seen.free;
        continue;
      }
      const MotionContact& what = contact->second;
      ASSERT_LE(what.lower, what.upper);
      if (what.upper == infinity) {
        ++seen.without_upper;
        continue;
      }
      const double gap = scene.gap(segment, object, what.upper);
      ASSERT_LE(gap, margin + scene.options.tolerance + slack);
      if (what.certain) {
        ASSERT_LE(gap, margin + slack);
      }
      ++(what.upper == 0.0 ? seen.touching : what.certain ? seen.certain : seen.perhaps);
    }
  }
}

class EnvironmentMotions : public testing::TestWithParam<ObjectMotion> {};

TEST_P(EnvironmentMotions, FindAllThatAnyTimeShows) {
  SCOPED_TRACE(seed_message());
  Random random;
  Seen seen;
  for (const double extent : {1e-6, 1.0, 1e4}) {
    for (int round = 0; round < rounds(40); ++round) {
      expect_true_of_all_times(random_scene(random, extent, GetParam()), extent, seen);
      ASSERT_FALSE(HasFatalFailure()) << extent << " " << round;
    }
  }
  expect_enough(seen.touching, rounds(300));
  expect_enough(seen.certain, rounds(300));
  expect_enough(seen.free, rounds(2000));
  expect_enough(seen.perhaps, 1);
  EXPECT_EQ(seen.without_upper, 0);
}

std::string name_of_object_motion(const testing::TestParamInfo<ObjectMotion>& motion) {
  const char* const words[] = {"StandStill", "GoStraight", "Turn", "GoByDisplacements"};
  return words[static_cast<int>(motion.param)];
}

INSTANTIATE_TEST_SUITE_P(Objects, EnvironmentMotions,
                         testing::Values(ObjectMotion::NONE, ObjectMotion::STRAIGHT,
                                         ObjectMotion::TURNING, ObjectMotion::DISPLACED),
                         name_of_object_motion);

/// All at the origin, flat, about 0.2 m wide, and so high above it [m].
std::vector<std::pair<Shape, double>> thin_things() {
  constexpr double thin = 1e-5;
  const Vector3d plate(0.2, 0.2, 2.0 * thin);
  std::vector<Vector3d> cells;
  for (int i = -5000; i < 7000; i += 8) {
    cells.emplace_back(thin * (i + 0.5), thin * 210.5, 0.5 * thin);  // a row under the cable
  }
  const std::vector<Vector3d> corners{
      {-0.1, -0.1, 0}, {0.1, -0.1, 0}, {0.1, 0.1, 0}, {-0.1, 0.1, 0}};
  using Triangles = std::vector<TriangleMesh::Triangle>;
  return {{BoxShape{plate}, thin},
          {CylinderShape{0.1, 2.0 * thin}, thin},
          {SphereShape{thin}, thin},
          {PlaneShape{Vector3d::UnitZ(), 0.0}, 0.0},
          {HalfSpaceShape{Vector3d::UnitZ(), 0.0}, 0.0},
          {box_mesh(plate, 5), thin},
          {std::make_shared<const TriangleMesh>(corners, Triangles{{0, 1, 2}, {0, 2, 3}}), 0.0},
          {octree_of(thin, cells), thin}};
}

const Isometry3d identity = Isometry3d::Identity();

TEST(EnvironmentMotion, ACableThatPassesThroughAThinThingInOneStepIsCaught) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const auto& [shape, height] : thin_things()) {
    SCOPED_TRACE(shape.index());
    const bool is_ball = std::holds_alternative<SphereShape>(shape);
    for (const double radius : {0.0, 1e-4, 3e-3}) {
      const double start = random.uniform(0.1, 1.0);
      const FiberAssembly before = cable(straight_cable(start), radius);
      const FiberAssembly after = cable(straight_cable(-start), radius);
      MotionOptions options;
      options.tolerance = 1e-9;
      const MotionResult result = ask({{"thing", identity, {{shape}}}}, before, after, options);
      if (is_ball && radius < 3e-3) {
        EXPECT_TRUE(result.contacts.empty());
        continue;
      }
      ASSERT_NE(result.earliest(), nullptr) << radius;
      const double above =
          is_ball ? std::sqrt(3.01e-3 * 3.01e-3 - 2.105e-3 * 2.105e-3) : height + radius;
      const double truth = (start - above) / (2.0 * start);
      for (const MotionContact& contact : result.contacts) {
        EXPECT_LE(contact.lower, truth + (is_ball ? 1e-3 : 1e-9)) << radius;
        // Without thickness nothing is ever deep in a sheet, nor in the surface of a mesh.
        const bool is_sheet =
            height == 0.0 || std::holds_alternative<std::shared_ptr<const TriangleMesh>>(shape);
        EXPECT_TRUE(contact.certain || (radius == 0.0 && is_sheet));
        EXPECT_GE(contact.upper, truth - 1e-8);
        EXPECT_LE(contact.upper - contact.lower, 1e-7);
      }
      EXPECT_NEAR(result.earliest()->lower, truth, 1e-8);
      EXPECT_GE(result.contacts.size(), is_ball ? 1U : 10U);
      EXPECT_TRUE(result.touching.empty());
    }
  }
}

FiberAssembly placed_cable(const Isometry3d& pose, std::vector<Vector3d> points, double radius) {
  for (Vector3d& point : points) {
    point = pose * point;
  }
  return cable(points, radius);
}

TEST(EnvironmentMotion, ACableThatSlidesAlongAThingIsFree) {
  SCOPED_TRACE(seed_message());
  Random random;
  constexpr double radius = 3e-3;
  std::uint64_t looks = 0;  // where boxes alone did not tell
  for (const auto& [shape, height] : thin_things()) {
    for (const double gap : {1e-3, 1e-6}) {
      SCOPED_TRACE(std::to_string(shape.index()) + " " + std::to_string(gap));
      const Isometry3d pose = random_pose(random, 1.0);
      const double z = height + radius + gap;
      std::vector<Vector3d> points = straight_cable(z, -0.05);
      const FiberAssembly before = placed_cable(pose, points, radius);
      points = straight_cable(z, 0.05);
      for (std::size_t i = 0; i < points.size(); i += 2) {
        points[i].z() += 0.01;  // turning up and down, it stays above
      }
      const FiberAssembly after = placed_cable(pose, points, radius);
      const std::vector<EnvironmentObject> thing{{"thing", pose, {{shape}}}};
      MotionOptions options;
      options.tolerance = 1e-9;
      MotionResult result = ask(thing, before, after, options);
      EXPECT_TRUE(result.contacts.empty() && result.touching.empty());
      EXPECT_EQ(result.others_lower, 1.0);
      looks += result.counts.primitive_tests;
      options.margin = 1.01 * gap;
      result = ask(thing, before, after, options);
      const bool is_ball = std::holds_alternative<SphereShape>(shape);  // it is beside the cable
      EXPECT_TRUE(is_ball || !result.touching.empty());
    }
  }
  EXPECT_GT(looks, 100U);
}

/// Across the upper edge of a box at x = 0.1 m, z = 0.05 m, this far from it and so steep.
std::vector<Vector3d> across_edge(double gap, double angle, double skew) {
  const Vector3d away(std::sin(angle), 0.0, std::cos(angle));
  const Vector3d along(std::cos(angle), skew, -std::sin(angle));
  const Vector3d middle = Vector3d(0.1, 0.0, 0.05) + gap * away;
  return {middle - 0.02 * along, middle + 0.03 * along};
}

TEST(EnvironmentMotion, ACableThatSeesawsOnAnEdgeIsFree) {
  SCOPED_TRACE(seed_message());
  Random random;
  const Vector3d size(0.2, 0.2, 0.1);
  const std::vector<Shape> shapes{BoxShape{size}, box_mesh(size, 4), CylinderShape{0.1, 0.1}};
  for (const double gap : {1e-3, 1e-5, 1e-7}) {
    for (const Shape& shape : shapes) {
      const Isometry3d pose = random_pose(random, 1.0);
      const double angle = random.uniform(0.3, 1.1);
      const double skew = random.uniform(-0.5, 0.5);
      const FiberAssembly before = placed_cable(pose, across_edge(gap, angle, skew), 0.0);
      const FiberAssembly after = placed_cable(pose, across_edge(gap, angle + 0.1, skew), 0.0);
      MotionOptions options;
      options.tolerance = 1e-9;
      EXPECT_TRUE(ask({{"thing", pose, {{shape}}}}, before, after, options).contacts.empty())
          << gap << " " << shape.index();
      options.margin = 1.01 * gap;
      EXPECT_FALSE(ask({{"thing", pose, {{shape}}}}, before, after, options).touching.empty());
    }
  }
}

TEST(EnvironmentMotion, ABladeThatTurnsThroughACableIsCaught) {
  // A plate 1 µm thick in the x-z plane, that turns about y by 170 degrees past a cable along y.
  const EnvironmentObject blade{"blade", identity, {{BoxShape{{1.0, 1.0, 1e-6}}}}};
  EnvironmentObject later = blade;
  constexpr double pi = 3.14159265358979323846;
  constexpr double angle = 170.0 * pi / 180.0;
  later.pose.linear() = Eigen::AngleAxisd(-angle, Vector3d::UnitY()).toRotationMatrix();
  const FiberAssembly fiber({{0.3, -0.01, 0.3}, {0.3, 0.01, 0.3}}, {0, 2}, {1e-3});
  MotionResult result;
  Environment({blade}).query_motion(fiber, fiber, Environment({later}), {}, {}, result);
  ASSERT_EQ(result.contacts.size(), 1U);
  const double far = 0.3 * std::sqrt(2.0);
  const double truth = (pi / 4.0 - std::asin((1e-3 + 0.5e-6) / far)) / angle;
  EXPECT_TRUE(result.contacts[0].certain);
  EXPECT_LE(result.contacts[0].lower, truth);
  EXPECT_GE(result.contacts[0].upper, truth);
  EXPECT_LE(result.contacts[0].upper - result.contacts[0].lower, 1e-5);
  // Where it stands still, or turns the other way, there is none.
  EXPECT_TRUE(ask({blade}, fiber, fiber, {}).contacts.empty());
  later.pose.linear() = Eigen::AngleAxisd(0.9 * angle, Vector3d::UnitY()).toRotationMatrix();
  Environment({blade}).query_motion(fiber, fiber, Environment({later}), {}, {}, result);
  ASSERT_EQ(result.contacts.size(), 1U) << "its other half comes round";
  EXPECT_GT(result.contacts[0].lower, 0.8);
  later.pose.linear() = Eigen::AngleAxisd(0.5 * angle, Vector3d::UnitY()).toRotationMatrix();
  Environment({blade}).query_motion(fiber, fiber, Environment({later}), {}, {}, result);
  EXPECT_TRUE(result.contacts.empty());
}

TEST(EnvironmentMotion, OfCablesThatStandStillThoseTouchThatAQueryReports) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::size_t touching = 0;
  for (int round = 0; round < rounds(50); ++round) {
    MotionScene scene = random_scene(random, 1.0, ObjectMotion::NONE);
    scene.fibers_after = scene.fibers_before;
    scene.options.tolerance = 0.0;
    const MotionResult result = scene.ask();
    QueryOptions options;
    options.margin = scene.options.margin;
    QueryResult contacts;
    Environment(scene.before).query(scene.fibers_before, options, {}, contacts);
    ASSERT_EQ(result.touching.size(), contacts.contacts.size());
    for (std::size_t i = 0; i < contacts.contacts.size(); ++i) {
      EXPECT_EQ(result.touching[i].key(), contacts.contacts[i].key());
    }
    for (const MotionContact& contact : result.contacts) {  // to the last roundings
      EXPECT_FALSE(contact.certain);
      EXPECT_NEAR(scene.gap(contact.segment_a, contact.fiber_b, 0.0), scene.options.margin, 1e-13);
    }
    touching += result.touching.size();
  }
  expect_enough(touching, static_cast<std::size_t>(rounds(50)));
}

}  // namespace
}  // namespace fiber::test

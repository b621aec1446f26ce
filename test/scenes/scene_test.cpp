#include "fiber_proximity/scenes/scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/scenes/scenes.hpp"
#include "test/support/error_of.hpp"
#include "test/support/hash.hpp"

namespace fiber {
namespace {

std::string refusal(const std::string& name, const SceneOptions& options) {
  return test::error_of([&] { make_scene(name, options)(0); });
}

TEST(Scene, UnknownNameIsRefusedWithTheKnownOnes) {
  const std::string message = refusal("spaghetti", {});
  EXPECT_NE(message.find("'spaghetti'"), std::string::npos) << message;
  for (const std::string& name : scene_names()) {
    EXPECT_NE(message.find(name), std::string::npos) << message;
  }
}

TEST(Scene, EverySceneKeepsItsTopologyAndMoves) {
  for (const std::string& name : scene_names()) {
    SCOPED_TRACE(name);
    const Scene scene = make_scene(name, {0.01, 5});
    const FiberAssembly first = scene(0);
    const FiberAssembly later = scene(7);
    EXPECT_GE(first.fiber_count(), 1U);
    EXPECT_EQ(first.offsets(), later.offsets());
    EXPECT_NE(first.points(), later.points());
    EXPECT_EQ(later.points(), scene(7).points()) << "a frame does not depend on those before";
  }
}

TEST(Scene, HasThePapersCounts) {
  struct Counts {
    std::string name;
    std::size_t fibers, segments;
  };
  const std::vector<Counts> all{
      {"tress_a", 2'500, 245'000},     {"tress_b", 500, 1'000'000},  {"tress_c", 1'000, 2'000'000},
      {"charming", 49'000, 2'401'000}, {"curly", 47'000, 4'700'000}, {"windy", 60'000, 3'000'000},
      {"longish", 39'000, 2'106'000},  {"cloth", 500, 1'300'000},    {"soup", 10'000, 1'000'000}};
  for (const Counts& expected : all) {
    SCOPED_TRACE(expected.name);
    const FiberAssembly fibers = make_scene(expected.name, {})(0);
    EXPECT_EQ(fibers.fiber_count(), expected.fibers);
    EXPECT_EQ(fibers.segment_count(), expected.segments);
    EXPECT_EQ(fibers.radii(), std::vector<double>{3.5e-5});
    const std::vector<std::uint32_t>& offsets = fibers.offsets();
    for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
      ASSERT_EQ(offsets[fiber + 1] - offsets[fiber], offsets[1]) << "for threading";
    }
  }
}

/// The points of each fibre, sorted.
std::vector<std::vector<double>> sorted_fibers(const FiberAssembly& fibers) {
  std::vector<std::vector<double>> all;
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    std::vector<double>& coordinates = all.emplace_back();
    for (std::size_t i = fibers.offsets()[fiber]; i < fibers.offsets()[fiber + 1]; ++i) {
      const Eigen::Vector3d& point = fibers.points()[i];
      for (const double coordinate : {point.x(), point.y(), point.z()}) {
        coordinates.push_back(coordinate);
      }
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

TEST(Scene, ShuffleOnlyChangesTheOrder) {
  for (const std::string name : {"tress_a", "windy", "soup"}) {
    SCOPED_TRACE(name);
    const FiberAssembly fibers = make_scene(name, {0.02, 4})(3);
    const FiberAssembly shuffled = make_scene(name, {0.02, 4, true})(3);
    EXPECT_EQ(sorted_fibers(shuffled), sorted_fibers(fibers));
    std::size_t in_place = 0;
    for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
      const std::uint32_t root = fibers.offsets()[fiber];
      in_place += fibers.points()[root] == shuffled.points()[root] ? 1U : 0U;
    }
    EXPECT_LT(in_place, 10U) << "of " << fibers.fiber_count();
  }
}

TEST(Scene, ShuffleKeepsTheOrderOverTheFrames) {
  const std::vector<std::uint32_t> order = random_order(50, 4);
  const Scene plain = make_scene("tress_a", {0.02, 4});
  const Scene shuffled = make_scene("tress_a", {0.02, 4, true});
  for (const std::uint32_t frame : {0U, 11U}) {
    EXPECT_EQ(shuffled(frame).points(), select_fibers(plain(frame), order).points());
  }
}

TEST(Shuffle, IsTheSameOrderOnEveryMachine) {
  EXPECT_EQ(random_order(8, 1), (std::vector<std::uint32_t>{2, 1, 7, 5, 0, 4, 3, 6}));
  EXPECT_EQ(random_order(8, 2), (std::vector<std::uint32_t>{3, 7, 4, 5, 2, 6, 0, 1}));
  EXPECT_EQ(random_order(1, 2), std::vector<std::uint32_t>{0});
  EXPECT_TRUE(random_order(0, 2).empty());
}

TEST(Soup, IsTheSameBitsOnEveryMachine) {
  EXPECT_EQ(test::hash(make_scene("soup", {0.01, 1})(0)), 191749915909879857U);
  EXPECT_EQ(test::hash(make_scene("soup", {0.01, 1})(33)), 18259788550278261293U);
  EXPECT_EQ(test::hash(make_scene("soup", {0.01, 2})(0)), 10581327338132598239U);
}

TEST(Soup, StaysInTheUnitCubeAndMovesSmoothly) {
  const Scene scene = make_scene("soup", {0.02, 3});
  FiberAssembly before = scene(0);
  for (std::uint32_t frame = 1; frame <= 100; ++frame) {
    FiberAssembly now = scene(frame);
    for (std::size_t point = 0; point < now.point_count(); ++point) {
      const Eigen::Vector3d& p = now.points()[point];
      ASSERT_TRUE(p.minCoeff() >= 0.0 && p.maxCoeff() <= 1.0) << p.transpose();
      // The steepest slope of the wave is 8 amplitudes per period.
      ASSERT_LE((p - before.points()[point]).norm(), 0.005 * 8.0 / 100.0 * 1.000001);
    }
    before = std::move(now);
  }
  EXPECT_EQ(before.points(), scene(0).points()) << "the sway repeats";
}

TEST(Soup, SegmentsAreAboutACentimetre) {
  const FiberAssembly fibers = make_scene("soup", {0.02, 3})(50);
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::size_t p = fibers.offsets()[fiber]; p + 1 < fibers.offsets()[fiber + 1]; ++p) {
      const double length = (fibers.points()[p + 1] - fibers.points()[p]).norm();
      ASSERT_NEAR(length, 0.01, 0.0005) << "fibre " << fiber;
    }
  }
}

TEST(Soup, ScaleIsChecked) {
  EXPECT_EQ(make_scene("soup", {0.5, 1})(0).fiber_count(), 5000U);
  EXPECT_EQ(make_scene("soup", {1e-9, 1})(0).fiber_count(), 1U);
  EXPECT_EQ(refusal("soup", {0.0, 1}), "scale is 0, it must be above 0 and at most 2126.22");
  EXPECT_EQ(refusal("soup", {-1.5, 1}), "scale is -1.5, it must be above 0 and at most 2126.22");
  EXPECT_EQ(refusal("soup", {2127.0, 1}), "scale is 2127, it must be above 0 and at most 2126.22");
  EXPECT_EQ(refusal("soup", {std::numeric_limits<double>::quiet_NaN(), 1}),
            "scale is nan, it must be above 0 and at most 2126.22");
}

}  // namespace
}  // namespace fiber

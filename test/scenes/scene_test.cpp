#include "fiber_proximity/scenes/scene.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <string>

namespace fiber {
namespace {

/// FNV-1a over the bits of the coordinates.
std::uint64_t hash(const FiberAssembly& fibers) {
  std::uint64_t result = 0xcbf2'9ce4'8422'2325U;
  for (const Eigen::Vector3d& point : fibers.points()) {
    for (const double coordinate : point) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &coordinate, sizeof(bits));
      for (int byte = 0; byte < 8; ++byte) {
        result = (result ^ ((bits >> (8 * byte)) & 0xffU)) * 0x100'0000'01b3U;
      }
    }
  }
  return result;
}

std::string refusal(const std::string& name, const SceneOptions& options) {
  try {
    make_scene(name, options)(0);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
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

TEST(Soup, HasThePapersCounts) {
  const FiberAssembly fibers = make_scene("soup", {})(0);
  EXPECT_EQ(fibers.fiber_count(), 10'000U);
  EXPECT_EQ(fibers.segment_count(), 1'000'000U);
  EXPECT_EQ(fibers.radii(), std::vector<double>{3.5e-5});
}

TEST(Soup, IsTheSameBitsOnEveryMachine) {
  EXPECT_EQ(hash(make_scene("soup", {0.01, 1})(0)), 191749915909879857U);
  EXPECT_EQ(hash(make_scene("soup", {0.01, 1})(33)), 18259788550278261293U);
  EXPECT_EQ(hash(make_scene("soup", {0.01, 2})(0)), 10581327338132598239U);
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
  EXPECT_EQ(refusal("soup", {0.0, 1}), "scale is 0, it must be above 0 and at most 2126");
  EXPECT_EQ(refusal("soup", {-1.5, 1}), "scale is -1.5, it must be above 0 and at most 2126");
  EXPECT_EQ(refusal("soup", {2127.0, 1}), "scale is 2127, it must be above 0 and at most 2126");
  EXPECT_EQ(refusal("soup", {std::numeric_limits<double>::quiet_NaN(), 1}),
            "scale is nan, it must be above 0 and at most 2126");
}

}  // namespace
}  // namespace fiber

#include "src/ros/outputs/label_place.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;
using fiber::FiberAssembly;

Vector3d place_in(const FiberAssembly& fibers, const Label& label) {
  return label_place(fibers, MarkerScale(fibers, "world"), label);
}

constexpr double height = 0.02;
constexpr double gap = 0.03;

Label label_at(const Vector3d& point) {
  return {point, Vector3d::UnitZ(), gap, height, 6, Vector3d::Zero(), {}};
}

TEST(LabelPlace, IsWherePreferredWhereThereIsRoom) {
  const FiberAssembly fibers({{-1, 0, 0}, {1, 0, 0}}, {0, 2}, {0.005});
  const Vector3d place = place_in(fibers, label_at({0.1, 0, 0}));
  EXPECT_NEAR((place - Vector3d(0.1, 0, gap + 0.5 * height)).norm(), 0.0, 1e-12);
}

TEST(LabelPlace, AFiberThatWouldHideItMovesIt) {
  // Another strand goes across right above, 10 cm before or behind it.
  for (const double depth : {-0.1, 0.1}) {
    const FiberAssembly fibers({{-1, 0, 0}, {1, 0, 0}, {-1, depth, 0.04}, {1, depth, 0.04}},
                               {0, 2, 4}, {0.005});
    const Vector3d place = place_in(fibers, label_at({0.1, 0, 0}));
    const Vector3d up(0.0, std::sin(0.6), std::cos(0.6));  // of who looks from −y, and from above
    for (const Vector3d& strand : {Vector3d(0, 0, 0), Vector3d(0, depth, 0.04)}) {
      EXPECT_GT(std::abs(up.dot(place - strand)), 0.5 * height + 0.005) << place.transpose();
    }
    EXPECT_LT((place - Vector3d(0.1, 0, 0)).norm(), 0.15) << "but stays near its point";
  }
}

TEST(LabelPlace, WithoutRoomAnywhereItStaysNearItsPoint) {
  std::vector<Vector3d> points;
  std::vector<std::uint32_t> offsets{0};
  for (int i = -50; i <= 50; ++i) {
    points.emplace_back(-1, 0, 0.005 * i);
    points.emplace_back(1, 0, 0.005 * i);
    offsets.push_back(static_cast<std::uint32_t>(points.size()));
  }
  const Vector3d place =
      place_in(FiberAssembly(points, offsets, {0.002}), label_at(Vector3d::Zero()));
  EXPECT_LT(place.norm(), 0.15);
  EXPECT_TRUE(place.allFinite());
}

TEST(LabelPlace, IsNotInsideTheBodyThatItNames) {
  // A fibre right below the point; what is above is inside.
  const FiberAssembly fibers({{-1, 0, -0.03}, {1, 0, -0.03}}, {0, 2}, {0.005});
  Label label = label_at(Vector3d::Zero());
  label.preferred = -Vector3d::UnitZ();
  EXPECT_GT(place_in(fibers, label).z(), 0.0) << "there is room above";
  label.inwards = Vector3d::UnitZ();
  EXPECT_LT(place_in(fibers, label).z(), -0.05) << "below the fibre";
  label.preferred = Vector3d::UnitX();
  label.inwards = -Vector3d::UnitX();
  EXPECT_GT(place_in(fibers, label).x(), -1e-12);
}

TEST(LabelPlace, DoesNotLieAcrossAnotherText) {
  const FiberAssembly fibers({{-1, 0, 0}, {1, 0, 0}}, {0, 2}, {0.005});
  Label label = label_at(Vector3d::Zero());
  const Vector3d alone = place_in(fibers, label);
  label.others = {{alone + Vector3d(0.01, 0, 0), height, 6}};
  const Vector3d beside = place_in(fibers, label);
  const Vector3d apart = (beside - label.others[0].middle).cwiseAbs();
  EXPECT_TRUE(apart.x() >= text_width(height, 6) || apart.z() >= height) << beside.transpose();
}

TEST(LabelPlace, ItsLeaderReachesIt) {
  const FiberAssembly fibers({{-1, 0, 0}, {1, 0, 0}}, {0, 2}, {0.005});
  const MarkerScale scale(fibers, "world");
  const Label label = label_at({0.1, 0, 0});
  for (const double gaps : {1.0, 3.0}) {
    const Vector3d place = label.point + Vector3d(0, 0, gaps * gap + 0.5 * height);
    const Vector3d end = leader_end(scale, label, place);
    EXPECT_NEAR(end.z(), 0.9 * gaps * gap, 1e-12) << "a little below the letters";
    EXPECT_NEAR(end.x(), 0.1, 1e-12);
  }
}

TEST(LabelPlace, AWideTextIsFurtherAwaySideways) {
  EXPECT_DOUBLE_EQ(text_width(0.02, 10), 2.0 * text_width(0.02, 5));
  Label label = label_at(Vector3d::Zero());
  label.preferred = Vector3d::UnitX();
  const FiberAssembly fibers({{0, 0, -1}, {0, 0, 1}, {1, 0, 1}}, {0, 3}, {0.005});
  EXPECT_NEAR(place_in(fibers, label).x(), gap + 0.5 * text_width(height, label.letters), 1e-12);
}

TEST(LabelPlace, OfVeryManySegmentsNoneIsLookedAt) {
  std::vector<Vector3d> points;
  for (std::size_t i = 0; i < max_label_segments + 2; ++i) {
    points.emplace_back(1e-4 * static_cast<double>(i) - 1.0, 0, 0.04);
  }
  const FiberAssembly fibers(points, {0, static_cast<std::uint32_t>(points.size())}, {0.005});
  EXPECT_NEAR(place_in(fibers, label_at(Vector3d::Zero())).z(), gap + 0.5 * height, 1e-12);
}

}  // namespace
}  // namespace fiber_proximity_ros

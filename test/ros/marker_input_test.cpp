#include "src/ros/inputs/marker_input.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "test/ros/marker_messages.hpp"
#include "test/support/not_finite.hpp"

namespace fiber_proximity_ros {
namespace {

using namespace marker_test;  // NOLINT(google-build-using-namespace)

TEST(MarkerInput, AListOfPointsIsAFibre) {
  for (const int type :
       {Marker::LINE_STRIP, Marker::POINTS, Marker::SPHERE_LIST, Marker::CUBE_LIST}) {
    const FiberBuffer buffer =
        read(array({marker(header("map"), type, chain(0)), marker(header("map"), type, chain(5))}));
    EXPECT_EQ(buffer.offsets, (std::vector<std::uint32_t>{0, 4, 8})) << type;
    EXPECT_EQ(Points(buffer.points.begin(), buffer.points.begin() + 4), chain(0)) << type;
    EXPECT_EQ(Points(buffer.points.begin() + 4, buffer.points.end()), chain(5)) << type;
    EXPECT_TRUE(buffer.radii.empty());
  }
}

TEST(MarkerInput, ASingleMarkerIsAFibreInItsFrame) {
  const FiberBuffer buffer = read(array({marker(header("map"), Marker::LINE_STRIP, chain(0))}));
  EXPECT_EQ(buffer.points, chain(0));
  EXPECT_EQ(buffer.header.frame_id, "map");
}

TEST(MarkerInput, TheMarkersPoseIsApplied) {
  Marker strip = marker(header("map"), Marker::LINE_STRIP, chain(0));
  const Eigen::Isometry3d pose = Eigen::Translation3d(1, 2, 3) *
                                 Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, -2, 0.5).normalized());
  const Eigen::Quaterniond q(pose.rotation());
  strip.pose.position = to_message(Eigen::Vector3d(pose.translation()));
  strip.pose.orientation.w = 2.0 * q.w();  // unit length is not to be relied on
  strip.pose.orientation.x = 2.0 * q.x();
  strip.pose.orientation.y = 2.0 * q.y();
  strip.pose.orientation.z = 2.0 * q.z();
  const FiberBuffer buffer = read(array({strip}));
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_LT((buffer.points[i] - pose * chain(0)[i]).norm(), 1e-14);
  }
  strip.pose.orientation = geometry_msgs::Quaternion();
  EXPECT_EQ(read(array({strip})).points[1], Eigen::Vector3d(1, 3, 3)) << "no orientation is none";
}

TEST(MarkerInput, LineListsAreWeldedWithATolerance) {
  Points pairs = segments(chain(0));
  pairs[2] += Eigen::Vector3d(0.1, 0, 0);  // a gap at the first joint
  std::swap(pairs[0], pairs[1]);           // segments turned round
  std::swap(pairs[4], pairs[5]);
  const FiberBuffer buffer = read(array({marker(header("map"), Marker::LINE_LIST, pairs)}));
  Points expected = chain(0);
  expected[1] += Eigen::Vector3d(0.05, 0, 0);
  EXPECT_EQ(buffer.points, expected);
  EXPECT_EQ(buffer.offsets, (std::vector<std::uint32_t>{0, 4}));

  MarkerInputOptions exact;
  exact.weld_tolerance = 0.05;
  EXPECT_EQ(read(array({marker(header("map"), Marker::LINE_LIST, pairs)}), exact).offsets,
            (std::vector<std::uint32_t>{0, 2, 5}));
}

TEST(MarkerInput, TheToleranceIsAPartOfTheShorterSegment) {
  MarkerInputOptions options;
  options.weld_tolerance = 0.1;
  const Points pairs{{0, 0, 0}, {1, 0, 0}, {1.05, 0, 0}, {1.15, 0, 0}};
  EXPECT_EQ(read(array({marker(header("map"), Marker::LINE_LIST, pairs)}), options).offsets,
            (std::vector<std::uint32_t>{0, 2, 4}));
}

TEST(MarkerInput, LineListsOfTwoMarkersAreTwoFibres) {
  const Points all = chain(0);
  const FiberBuffer buffer =
      read(array({marker(header("map"), Marker::LINE_LIST, segments({all[0], all[1], all[2]})),
                  marker(header("map"), Marker::LINE_LIST, segments({all[2], all[3]}))}));
  EXPECT_EQ(buffer.offsets, (std::vector<std::uint32_t>{0, 3, 5}));
}

TEST(MarkerInput, StripsOfTwoPointsAreWelded) {
  std::vector<Marker> strips;
  const Points pairs = segments(chain(0));
  for (std::size_t i = 0; i < pairs.size(); i += 2) {
    strips.push_back(marker(header("map"), Marker::LINE_STRIP, {pairs[i], pairs[i + 1]}));
  }
  MarkerArray message = array(strips);
  message.markers.emplace_back();  // a planner that sizes its array one too large
  const FiberBuffer buffer = read(message);
  EXPECT_EQ(buffer.points, chain(0));
  EXPECT_EQ(buffer.offsets, (std::vector<std::uint32_t>{0, 4}));
}

TEST(MarkerInput, LinesWinOverPointsOfTheSameCable) {
  const FiberBuffer buffer =
      read(array({marker(header("map"), Marker::POINTS, {{9, 9, 9}, {8, 8, 8}}),
                  marker(header("map"), Marker::LINE_LIST, segments(chain(0)))}));
  EXPECT_EQ(buffer.points, chain(0));
}

TEST(MarkerInput, SpheresAreAFibreInTheOrderOfTheirIds) {
  MarkerArray message = test_messages::spheres_and_cylinders(header("map"), chain(2));
  std::reverse(message.markers.begin(), message.markers.end());
  EXPECT_EQ(read(message).points, chain(2));

  message.markers[0].type = Marker::CUBE;  // some draw every fifth one so
  message.markers[1].type = Marker::CUBE;
  EXPECT_EQ(refusal_of(message),
            "marker line_3/3 and marker node_3/3 have the same id, so their "
            "order along the fibre is unknown; choose one fibre by its "
            "namespace");
}

TEST(MarkerInput, CylindersAreWeldedAlongTheirAxes) {
  MarkerArray message;
  for (int i = 0; i < 3; ++i) {
    Marker cylinder = marker(header("map"), Marker::CYLINDER, {});
    cylinder.id = 2 - i;
    cylinder.scale.z = 0.5;
    cylinder.pose.position.x = 0.25 - 0.5 * i;
    cylinder.pose.orientation.w = std::sqrt(0.5);
    cylinder.pose.orientation.y = std::sqrt(0.5);  // z to x
    message.markers.push_back(cylinder);
  }
  MarkerInputOptions options;
  options.radius_from_marker = true;
  const FiberBuffer buffer = read(message, options);
  ASSERT_EQ(buffer.offsets, (std::vector<std::uint32_t>{0, 4}));
  EXPECT_EQ(buffer.radii, std::vector<double>{0.01});
  for (int i = 0; i < 4; ++i) {
    EXPECT_LT(
        (buffer.points[static_cast<std::size_t>(i)] - Eigen::Vector3d(-1 + 0.5 * i, 0, 0)).norm(),
        1e-14);
  }
}

using fiber::test::nan;
const Eigen::Vector3d missing_point(nan, nan, nan);

/// A character per point: k known, m missing, a bar between fibres.
std::string pattern_of(const FiberBuffer& buffer) {
  std::string pattern;
  for (std::size_t i = 0; i < buffer.points.size(); ++i) {
    const auto begin = std::find(buffer.offsets.begin(), buffer.offsets.end(), i);
    pattern += begin != buffer.offsets.end() && i > 0 ? "|" : "";
    pattern += buffer.points[i].allFinite() ? "k" : "m";
  }
  return pattern;
}

TEST(MarkerInput, AMissingPointOfALineListIsInItsChainWhateverElseIsMissing) {
  for (unsigned lost = 0; lost < 64; ++lost) {
    Points points;
    std::string expected;
    for (unsigned i = 0; i < 6; ++i) {
      const bool is_lost = ((lost >> i) & 1U) != 0;
      points.push_back(is_lost ? missing_point : Eigen::Vector3d(i, i % 2, 0));
      expected += is_lost ? "m" : "k";
    }
    const FiberBuffer lines =
        read(array({marker(header("map"), Marker::LINE_LIST, segments(points))}));
    EXPECT_EQ(pattern_of(lines), expected);
    const FiberBuffer strip = read(array({marker(header("map"), Marker::LINE_STRIP, points)}));
    for (std::size_t i = 0; i < std::min(points.size(), lines.points.size()); ++i) {
      EXPECT_EQ(lines.points[i].allFinite() ? lines.points[i] : Eigen::Vector3d::Zero(),
                strip.points[i].allFinite() ? strip.points[i] : Eigen::Vector3d::Zero());
    }
  }
}

TEST(MarkerInput, AMissingEndOfALineListDoesNotJoinAnotherFibreFarAway) {
  Points pairs = segments({{0, 0, 0}, {1, 0, 0}, missing_point});
  const Points far = segments({{0, 9, 0}, {1, 9, 0}, {2, 9, 0}});
  pairs.insert(pairs.end(), far.begin(), far.end());
  EXPECT_EQ(pattern_of(read(array({marker(header("map"), Marker::LINE_LIST, pairs)}))), "kkm|kkk");
}

TEST(MarkerInput, AMissingCylinderIsAGapOfItsFibre) {
  MarkerArray message;
  for (int i = 0; i < 5; ++i) {
    Marker cylinder = marker(header("map"), Marker::CYLINDER, {});
    cylinder.id = i;
    cylinder.scale.z = 0.5;
    cylinder.pose.position.z = i == 2 ? nan : 0.5 * i;
    message.markers.push_back(cylinder);
  }
  MarkerInputOptions options;
  options.radius_from_marker = true;
  const FiberBuffer buffer = read(message, options);
  EXPECT_EQ(pattern_of(buffer), "kkkmkkk");
  EXPECT_EQ(buffer.radii, std::vector<double>{0.01});
}

TEST(MarkerInput, RadiusFromMarkerIsHalfItsWidthPerFibre) {
  MarkerInputOptions options;
  options.radius_from_marker = true;
  MarkerArray message = array({marker(header("map"), Marker::LINE_STRIP, chain(0)),
                               marker(header("map"), Marker::LINE_LIST, segments(chain(3)))});
  message.markers[1].scale.x = 0.5;
  EXPECT_EQ(read(message, options).radii, (std::vector<double>{0.01, 0.25}));
}

TEST(MarkerInput, OnlyTheChosenNamespaceIsRead) {
  MarkerArray message = array({marker(header("map"), Marker::LINE_STRIP, chain(0)),
                               marker(header("map"), Marker::LINE_STRIP, chain(3))});
  message.markers[1].ns = "other";
  MarkerInputOptions options;
  options.marker_namespace = "other";
  EXPECT_EQ(read(message, options).points, chain(3));
  options.marker_namespace = "nobody";
  FiberBuffer buffer;
  EXPECT_FALSE(read_first(message, options, buffer).is_for_input);
}

TEST(MarkerInput, DeletionsAreNoFibres) {
  MarkerArray message = array({marker(header("map"), Marker::LINE_STRIP, chain(0)),
                               marker(header("map"), Marker::LINE_STRIP, chain(3))});
  message.markers[0].action = Marker::DELETEALL;
  EXPECT_EQ(read(message).points, chain(3));
  message.markers[1].action = Marker::DELETE;
  FiberBuffer buffer;
  EXPECT_FALSE(read_first(message, {}, buffer).is_for_input) << "there has been none";
}

TEST(MarkerInput, MalformedMarkersAreRefused) {
  Points odd = segments(chain(0));
  odd.pop_back();
  EXPECT_EQ(refusal_of(array({marker(header("map"), Marker::LINE_LIST, odd)})),
            "marker cable/0: a LINE_LIST of 5 points, it must have two per segment and not be "
            "empty");
  EXPECT_EQ(refusal_of(array({marker(header("map"), Marker::TEXT_VIEW_FACING, {})})),
            "marker cable/0 has type 9; fibres are read from LINE_STRIP, LINE_LIST, POINTS, "
            "SPHERE_LIST, CUBE_LIST, SPHERE, CUBE and CYLINDER");
  EXPECT_EQ(refusal_of(array({marker(header("map"), Marker::LINE_STRIP, chain(0)),
                              marker(header("camera"), Marker::LINE_STRIP, chain(0))})),
            "marker cable/1 is in frame 'camera', marker cable/0 in 'map'; they must be the same");
  Marker unprintable = marker(header("map"), Marker::TEXT_VIEW_FACING, {});
  unprintable.ns = "ca\nble";
  EXPECT_EQ(refusal_of(array({unprintable})).substr(0, 18), "marker ca\\nble/0 h");
  Marker odd_action = marker(header("map"), Marker::LINE_STRIP, chain(0));
  odd_action.action = 9;
  EXPECT_EQ(refusal_of(array({odd_action})),
            "marker cable/0: action is 9, it must be 0 (ADD), 2 (DELETE) or 3 (DELETEALL)");
  Marker past = marker(header("map"), Marker::LINE_STRIP, chain(0));
  past.lifetime = ros::Duration(-5.0);
  EXPECT_EQ(refusal_of(array({past})).rfind("marker cable/0: lifetime is -5", 0), 0U);
}

/// The fibres of several namespaces, with the names "tree/…".
FiberBuffer read_named(const MarkerArray& message) {
  MarkerInputOptions options;
  options.name = "tree";
  return read(message, options);
}

TEST(MarkerInput, StraightCablesInTwoNamespacesAreTwoFibresAsTheyAre) {
  const Points first{{0, 0, 0}, {1, 0, 0}};
  for (const Points& second : {Points{{0, 0.1, 0}, {1, 0.1, 0}},         // beside it
                               Points{{1, 0.1, 0}, {0, 0.1, 0}},         // the other way round
                               Points{{1.2, 0.1, 0}, {2.2, 0.1, 0}}}) {  // behind it
    MarkerArray message;
    message.markers = {strip_of("tether_1", first), strip_of("tether_2", second)};
    const FiberBuffer buffer = read_named(message);
    ASSERT_EQ(buffer.offsets, (std::vector<std::uint32_t>{0, 2, 4}));
    EXPECT_EQ(Points(buffer.points.begin(), buffer.points.begin() + 2), first);
    EXPECT_EQ(Points(buffer.points.begin() + 2, buffer.points.end()), second);
    EXPECT_EQ(buffer.names, (std::vector<std::string>{"tree/tether_1", "tree/tether_2"}));
  }
}

TEST(MarkerInput, SegmentsInNamespacesOfTheirOwnAreWeldedWhereTheyCoincide) {
  MarkerArray message;
  const Points all = chain(0);
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    Marker strip = strip_of("line_" + std::to_string(i), {all[i], all[i + 1]});
    strip.id = static_cast<std::int32_t>(i);
    message.markers.push_back(strip);
  }
  message.markers[1].points[0].x += 1e-4;
  EXPECT_EQ(read_named(message).offsets, (std::vector<std::uint32_t>{0, 4}));
  EXPECT_EQ(read_named(message).names, std::vector<std::string>{"tree"});
  message.markers[1].points[0].x += 1e-2;
  EXPECT_EQ(read_named(message).offsets, (std::vector<std::uint32_t>{0, 2, 5}));
}

TEST(MarkerInput, ANamespaceOfSeveralSpheresIsAFibreOfItsOwn) {
  MarkerArray message;
  for (int i = 0; i < 6; ++i) {
    Marker sphere = marker(header("map"), Marker::SPHERE, {});
    sphere.ns = i < 3 ? "a" : "b";
    sphere.id = i < 3 ? i : 7 + i;
    sphere.pose.position.x = 0.5 * (i % 3);
    sphere.pose.position.y = i < 3 ? 0.0 : 0.3;
    message.markers.push_back(sphere);
  }
  const FiberBuffer buffer = read_named(message);
  EXPECT_EQ(buffer.offsets, (std::vector<std::uint32_t>{0, 3, 6}));
  EXPECT_EQ(buffer.points[3], Eigen::Vector3d(0, 0.3, 0));
  EXPECT_EQ(buffer.names, (std::vector<std::string>{"tree/a", "tree/b"}));
}

TEST(MarkerInput, WhatIsTurnedRoundOrMovedIsTold) {
  const Points all = chain(0);
  const auto remarks_of = [](const Points& pairs) {
    FiberBuffer buffer;
    return read_first(array({marker(header("map"), Marker::LINE_LIST, pairs)}), {}, buffer).remarks;
  };
  EXPECT_TRUE(remarks_of(segments(all)).empty());
  Points turned = segments(all);
  std::swap(turned[2], turned[3]);
  ASSERT_EQ(remarks_of(turned).size(), 1U);
  EXPECT_EQ(remarks_of(turned)[0].rfind("1 segment(s) are turned round", 0), 0U);
  Points apart = segments(all);
  apart[2].x() += 0.1;
  ASSERT_EQ(remarks_of(apart).size(), 1U);
  EXPECT_EQ(remarks_of(apart)[0].rfind("ends up to 0.1 m apart are moved together", 0), 0U)
      << remarks_of(apart)[0];
}

}  // namespace
}  // namespace fiber_proximity_ros

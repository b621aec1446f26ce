#include "src/rviz/fiber_colors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <set>
#include <stdexcept>
#include <vector>

#include "test/support/not_finite.hpp"

namespace fiber_proximity_rviz {
namespace {

using fiber::FiberAssembly;
using fiber::test::nan;
using Values = std::vector<std::optional<double>>;

constexpr Color grey{90, 90, 90, 128};

/// Fibres of three and two segments.
FiberAssembly two_fibers(const std::vector<double>& radii = {0.1}) {
  return {{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}},
          {0, 4, 7},
          radii};
}

fiber_proximity::Contact contact(std::uint32_t fiber_a, std::uint32_t segment_a,
                                 std::uint32_t fiber_b, std::uint32_t segment_b, double distance) {
  fiber_proximity::Contact contact;
  contact.fiber_a = fiber_a;
  contact.segment_a = segment_a;
  contact.fiber_b = fiber_b;
  contact.segment_b = segment_b;
  contact.distance = distance;
  return contact;
}

TEST(FiberColors, PartsAreRoundedAndClamped) {
  EXPECT_EQ(to_color({0.0F, 0.5F, 1.0F}, 0.25F), (Color{0, 128, 255, 64}));
  EXPECT_EQ(to_color({-1.0F, 2.0F, 0.2F}, 7.0F), (Color{0, 255, 51, 255}));
}

TEST(FiberColors, RampRunsFromBlueToRedWithoutJumps) {
  EXPECT_GT(color_map(0.0)[2], 2.0F * color_map(0.0)[0]);
  EXPECT_GT(color_map(1.0)[0], 2.0F * color_map(1.0)[2]);
  EXPECT_EQ(color_map(-1.0), color_map(0.0));
  EXPECT_EQ(color_map(1e300), color_map(1.0));
  for (int i = 0; i < 1000; ++i) {
    for (std::size_t part = 0; part < 3; ++part) {
      EXPECT_NEAR(color_map(0.001 * i)[part], color_map(0.001 * (i + 1))[part], 0.004) << i;
    }
  }
}

TEST(FiberColors, FibersHaveOneColourEach) {
  const FiberAssembly fibers = two_fibers();
  std::vector<Color> colors(100);  // overwritten
  color_by_fiber(fibers, 0.5F, colors);
  ASSERT_EQ(colors.size(), fibers.point_count());
  for (std::size_t i = 0; i < colors.size(); ++i) {
    EXPECT_EQ(colors[i], colors[i < 4 ? 0 : 4]);
    EXPECT_EQ(colors[i][3], 128);
  }
  EXPECT_NE(colors[0], colors[4]);
}

TEST(FiberColors, AlikeStillTellsFibersApart) {
  std::vector<Eigen::Vector3d> points(20, Eigen::Vector3d::Zero());
  const FiberAssembly fibers(points, {0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20}, {0.1});
  std::vector<Color> colors;
  color_flat(fibers, {100, 200, 40, 77}, colors);
  ASSERT_EQ(colors.size(), points.size());
  std::set<Color> different(colors.begin(), colors.end());
  EXPECT_EQ(different.size(), 10U);
  for (const Color& color : colors) {
    EXPECT_NEAR(color[0], 100, 26);
    EXPECT_NEAR(color[1], 2 * color[0], 2);  // the same hue
    EXPECT_EQ(color[3], 77);
  }
}

TEST(FiberColors, ValuesSpanTheRange) {
  std::vector<Color> colors;
  color_by_value({{0.02}, {0.04}, {0.03}, std::nullopt}, {0.02, 0.04}, grey, colors);
  EXPECT_EQ(colors, (std::vector<Color>{to_color(color_map(0.0), 128.0F / 255.0F),
                                        to_color(color_map(1.0), 128.0F / 255.0F),
                                        to_color(color_map(0.5), 128.0F / 255.0F), grey}));
  // Turned round, and without width.
  color_by_value({{0.02}}, {0.04, 0.02}, grey, colors);
  EXPECT_EQ(colors[0], to_color(color_map(1.0), 128.0F / 255.0F));
  color_by_value({{0.02}}, {0.02, 0.02}, grey, colors);
  EXPECT_EQ(colors[0], to_color(color_map(0.5), 128.0F / 255.0F));
}

TEST(FiberColors, RangeIsThatOfTheValues) {
  const ValueRange range = range_of({std::nullopt, {3.0}, {-1.0}, {2.0}});
  EXPECT_EQ(range.at_blue, -1.0);
  EXPECT_EQ(range.at_red, 3.0);
  EXPECT_EQ(range_of({std::nullopt}).at_red, 1.0);
}

TEST(FiberColors, RadiiAreThoseOfTheSegments) {
  const Values all_alike = radii_of_points(two_fibers({0.1}));
  EXPECT_EQ(all_alike, Values(7, 0.1));
  const Values by_fiber = radii_of_points(two_fibers({0.1, 0.2}));
  EXPECT_EQ(by_fiber, (Values{0.1, 0.1, 0.1, 0.1, 0.2, 0.2, 0.2}));
  // A segment has the larger radius of its two points.
  const Values by_point = radii_of_points(two_fibers({0.4, 0.3, 0.2, 0.1, 0.5, 0.5, 0.6}));
  EXPECT_EQ(by_point, (Values{0.4, 0.3, 0.2, 0.2, 0.5, 0.6, 0.6}));
}

TEST(FiberColors, DistancesAreTheLeastOfThoseThatNameAPoint) {
  fiber_proximity::ContactArray contacts;
  contacts.contacts = {contact(0, 0, 1, 1, 0.3), contact(0, 1, 1, 1, -0.2)};
  EXPECT_EQ(distances_of_points(two_fibers(), contacts),
            (Values{0.3, -0.2, -0.2, std::nullopt, std::nullopt, -0.2, -0.2}));

  // The closest pair counts as well, a query's shape is no fibre.
  contacts.contacts = {contact(7, 7, 1, 0, 0.1)};
  contacts.contacts[0].type_a = fiber_proximity::Contact::SHAPE;
  contacts.has_minimum = true;
  contacts.minimum = contact(0, 2, 1, 0, 0.4);
  EXPECT_EQ(distances_of_points(two_fibers(), contacts),
            (Values{std::nullopt, std::nullopt, 0.4, 0.4, 0.1, 0.1, std::nullopt}));
}

TEST(FiberColors, ContactsThatDoNotFitAreRefused) {
  const FiberAssembly fibers = two_fibers();
  for (const fiber_proximity::Contact& bad :
       {contact(0, 3, 1, 0, 0.1), contact(0, 0, 1, 2, 0.1), contact(2, 0, 1, 0, 0.1),
        contact(0, 0, 0xFFFFFFFF, 0, 0.1), contact(0, 0, 1, 0xFFFFFFFF, 0.1),
        contact(0, 0, 1, 0, nan), contact(0, 0, 1, 0, HUGE_VAL)}) {
    fiber_proximity::ContactArray contacts;
    contacts.contacts = {bad};
    EXPECT_THROW(distances_of_points(fibers, contacts), std::invalid_argument);
    contacts.contacts.clear();
    contacts.minimum = bad;
    EXPECT_NO_THROW(distances_of_points(fibers, contacts));
    contacts.has_minimum = true;
    EXPECT_THROW(distances_of_points(fibers, contacts), std::invalid_argument);
  }
}

}  // namespace
}  // namespace fiber_proximity_rviz

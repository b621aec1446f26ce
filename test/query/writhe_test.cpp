#include <gtest/gtest.h>

#include "fiber_proximity/query/crossings.hpp"
#include "test/support/curves.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// Mean of the sums of signs over directions spread evenly on a half sphere.
double mean_of_signs(const FiberAssembly& fibers, int directions) {
  const double golden = turn * 0.38196601125010515;
  CrossingFinder finder;
  std::vector<Crossing> crossings;
  double sum = 0.0;
  for (int i = 0; i < directions; ++i) {
    const double z = (i + 0.5) / directions;
    const double r = std::sqrt(1.0 - z * z);
    View view;
    view.direction = {r * std::cos(golden * i), r * std::sin(golden * i), z};
    finder.find(fibers, view, crossings);
    for (const Crossing& crossing : crossings) {
      sum += crossing.sign;
    }
  }
  return sum / directions;
}

TEST(Writhe, OfCurvesInAPlaneIsNothing) {
  SCOPED_TRACE(seed_message());
  Random random(23);
  Curve flat = random_curve(random, 40);
  for (Vector3d& point : flat) {
    point.z() = 0.25;
  }
  EXPECT_EQ(writhe(flat), 0.0);
  EXPECT_EQ(writhe(flat, CurveEnds::CLOSED), 0.0);
  EXPECT_EQ(writhe(Curve()), 0.0);
  EXPECT_EQ(writhe(Curve(), CurveEnds::CLOSED), 0.0);
  EXPECT_EQ(writhe({{1, 2, 3}}, CurveEnds::CLOSED), 0.0);
  const Eigen::AngleAxisd rotation(1.0, Vector3d(1, 2, 3).normalized());
  const Curve tilted =
      mapped(circle(100), [&](const Vector3d& p) { return Vector3d(rotation * p); });
  EXPECT_NEAR(writhe(tilted, CurveEnds::CLOSED), 0.0, 1e-12);
}

TEST(Writhe, OfKnownKnots) {
  const double left_trefoil = writhe(trefoil(200), CurveEnds::CLOSED);
  EXPECT_NEAR(left_trefoil, -3.5, 0.3);
  EXPECT_NEAR(writhe(mirrored(trefoil(200)), CurveEnds::CLOSED), -left_trefoil, 1e-12);
  EXPECT_NEAR(writhe(reversed(trefoil(200)), CurveEnds::CLOSED), left_trefoil, 1e-12);
  EXPECT_NEAR(writhe(figure_eight(200), CurveEnds::CLOSED), 0.0, 0.1);
}

// A crown, up and down in turn: turned by one point it is its mirror image.
TEST(Writhe, OfACurveThatIsItsOwnMirrorImageIsNothing) {
  Curve crown = circle(30);
  for (std::size_t i = 0; i < crown.size(); ++i) {
    crown[i].z() = i % 2 == 0 ? 0.7 : -0.7;
  }
  EXPECT_NEAR(writhe(crown, CurveEnds::CLOSED), 0.0, 1e-13);
}

TEST(Writhe, IsTheMeanOfTheSumsOfSigns) {
  SCOPED_TRACE(seed_message());
  Random random(24);
  const Curve curve = random_curve(random, 15);
  EXPECT_NEAR(writhe(curve), mean_of_signs(as_fibers({curve}), 20000), 0.1);
  EXPECT_NEAR(writhe(curve, CurveEnds::CLOSED), mean_of_signs(as_fibers({closed(curve)}), 20000),
              0.1);
  EXPECT_NEAR(writhe(curve, CurveEnds::CLOSED), writhe(closed(curve)), 1e-12);
}

// The same bits, with points twice, in another place and size.
TEST(Writhe, DoesNotDependOnPlaceScaleOrSampling) {
  const Curve knot = mapped(trefoil(50), [](const Vector3d& p) {
    return Vector3d((p * 0x1p20).array().round().matrix() * 0x1p-20);
  });
  const double expected = writhe(knot, CurveEnds::CLOSED);
  EXPECT_EQ(writhe(knot, CurveEnds::CLOSED), expected);
  const Curve away = mapped(
      knot, [](const Vector3d& p) { return Vector3d(p + Vector3d(0x1p20, -0x1p21, 0x1p20)); });
  EXPECT_EQ(writhe(away, CurveEnds::CLOSED), expected);
  const Curve tiny = mapped(knot, [](const Vector3d& p) { return Vector3d(0x1p-800 * p); });
  EXPECT_EQ(writhe(tiny, CurveEnds::CLOSED), expected);
  Curve doubled;
  for (const Vector3d& point : knot) {
    doubled.insert(doubled.end(), 2, point);
  }
  EXPECT_NEAR(writhe(doubled, CurveEnds::CLOSED), expected, 1e-12);
}

}  // namespace
}  // namespace fiber::test

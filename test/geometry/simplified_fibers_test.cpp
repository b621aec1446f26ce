#include "fiber_proximity/geometry/simplified_fibers.hpp"

#include <gtest/gtest.h>

#include "support/exact_distance.hpp"
#include "support/simplifiable.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// Calls with fibres of all families, simplified by parts of their size.
template <class Call>
void for_each_simplified(const Call& call) {
  SCOPED_TRACE(seed_message());
  Random random;
  SimplifiedFibers simplified;
  for (const AssemblyFamily& family : simplifiable_families()) {
    for (const double part : {0.0, 1e-4, 1e-2, 1.0}) {
      SCOPED_TRACE(family.name + ", deviation " + std::to_string(part) + " of the size");
      const FiberAssembly fibers = family.make(random);
      const double deviation = part * size_of(fibers);
      simplified.update(fibers, deviation);
      call(fibers, simplified, deviation, random);
      if (testing::Test::HasFatalFailure()) {
        return;
      }
    }
  }
}

template <class Call>
void for_each_piece(const SimplifiedFibers& simplified, const Call& call) {
  const std::vector<std::uint32_t>& offsets = simplified.assembly().offsets();
  for (std::size_t fiber = 0; fiber + 1 < offsets.size(); ++fiber) {
    for (std::uint32_t piece = offsets[fiber]; piece + 1 < offsets[fiber + 1]; ++piece) {
      call(piece);
    }
  }
}

TEST(SimplifiedFibers, ArePiecesFromPointToPointOfTheSameFibers) {
  for_each_simplified([](const FiberAssembly& fibers, const SimplifiedFibers& simplified,
                         double /*deviation*/, Random& /*random*/) {
    const FiberAssembly& pieces = simplified.assembly();
    ASSERT_EQ(pieces.fiber_count(), fibers.fiber_count());
    for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
      ASSERT_EQ(simplified.run_begin(pieces.offsets()[fiber]), fibers.offsets()[fiber]);
      ASSERT_EQ(simplified.run_end(pieces.offsets()[fiber + 1] - 2),
                fibers.offsets()[fiber + 1] - 1);
    }
    for_each_piece(simplified, [&](std::uint32_t piece) {
      ASSERT_LT(simplified.run_begin(piece), simplified.run_end(piece));
      ASSERT_EQ(pieces.points()[piece], fibers.points()[simplified.run_begin(piece)]);
      ASSERT_EQ(pieces.points()[piece + 1], fibers.points()[simplified.run_end(piece)]);
    });
  });
}

TEST(SimplifiedFibers, EncloseTheirRunsWithinTheDeviation) {
  for_each_simplified([](const FiberAssembly& fibers, const SimplifiedFibers& simplified,
                         double deviation, Random& /*random*/) {
    for_each_piece(simplified, [&](std::uint32_t piece) {
      const Capsule capsule = simplified.assembly().capsule(piece);
      const double e = simplified.deviation(piece);
      const double spread = simplified.spread(piece);
      ASSERT_LE(e, deviation);
      ASSERT_LE(spread, 2.0 * deviation + 1e-15 * capsule.radius);
      for (std::uint32_t i = simplified.run_begin(piece); i < simplified.run_end(piece); ++i) {
        const double radius = fibers.segment_radius(i);
        ASSERT_LE(squared_distance(exact(fibers.points()[i]), exact(capsule.p0), exact(capsule.p1)),
                  Rational(e) * Rational(e));
        ASSERT_GE(Rational(capsule.radius), Rational(radius) + Rational(e));
        ASSERT_GE(Rational(spread), Rational(capsule.radius) - Rational(radius) + Rational(e));
      }
      if (simplified.run_end(piece) - simplified.run_begin(piece) == 1) {
        ASSERT_EQ(e, 0.0);
        ASSERT_EQ(spread, 0.0);
        ASSERT_EQ(capsule.radius, fibers.segment_radius(simplified.run_begin(piece)));
      }
    });
  });
}

TEST(SimplifiedFibers, KnowHowFarEachSegmentGoesOn) {
  for_each_simplified([](const FiberAssembly& fibers, const SimplifiedFibers& simplified,
                         double /*deviation*/, Random& /*random*/) {
    for_each_piece(simplified, [&](std::uint32_t piece) {
      const Capsule capsule = simplified.assembly().capsule(piece);
      const ExactVector u = add_scaled(exact(capsule.p1), -1, exact(capsule.p0));
      const Rational advance(simplified.advance(piece));
      for (std::uint32_t i = simplified.run_begin(piece); i < simplified.run_end(piece); ++i) {
        const ExactVector step =
            add_scaled(exact(fibers.points()[i + 1]), -1, exact(fibers.points()[i]));
        const Rational along = dot(step, u);
        if (advance > 0) {  // in squares, as lengths are not rational
          ASSERT_GE(along, 0);
          ASSERT_GE(along * along, advance * advance * dot(u, u));
        }
      }
    });
  });
}

TEST(SimplifiedFibers, PlaceAPointOfTheRunWithinTheDeviation) {
  for_each_simplified([](const FiberAssembly& fibers, const SimplifiedFibers& simplified,
                         double /*deviation*/, Random& random) {
    for_each_piece(simplified, [&](std::uint32_t piece) {
      for (const double s : {0.0, 1.0, random.uniform(0.0, 1.0)}) {
        const SimplifiedFibers::Place place = simplified.place(fibers, piece, s);
        ASSERT_GE(place.point, simplified.run_begin(piece));
        ASSERT_LT(place.point, simplified.run_end(piece));
        ASSERT_TRUE(place.s >= 0.0 && place.s <= 1.0) << place.s;
        const Capsule capsule = simplified.assembly().capsule(piece);
        const Capsule segment = fibers.capsule(place.point);
        const Vector3d apart = (1.0 - s) * capsule.p0 + s * capsule.p1 -
                               (1.0 - place.s) * segment.p0 - place.s * segment.p1;
        const double rounding = 1e-14 * (capsule.p0.cwiseAbs() + capsule.p1.cwiseAbs()).maxCoeff();
        ASSERT_LE(apart.stableNorm(), simplified.deviation(piece) * (1.0 + 1e-12) + rounding);
      }
    });
  });
}

TEST(SimplifiedFibers, AreFewWhereFibersAreDenseAndTheSameWithoutADeviation) {
  SCOPED_TRACE(seed_message());
  Random random;
  SimplifiedFibers simplified;
  for (const AssemblyFamily& family : dense_families()) {
    const FiberAssembly fibers = family.make(random);
    simplified.update(fibers, 0.0);
    EXPECT_EQ(simplified.assembly().points(), fibers.points()) << family.name;
    simplified.update(fibers, 0.03);
    EXPECT_LT(2 * simplified.assembly().segment_count(), fibers.segment_count()) << family.name;
  }
}

TEST(SimplifiedFibers, HaveRunsOfBoundedLength) {
  AssemblyBuilder builder;
  builder.add_fiber(sampled(129, [](double x) { return Vector3d(x, 0.0, 0.0); }));
  SimplifiedFibers simplified;
  simplified.update(builder.build({0.1}), 1.0);
  EXPECT_EQ(SimplifiedFibers::most_segments, 64U);
  EXPECT_EQ(simplified.assembly().offsets(), (std::vector<std::uint32_t>{0, 4}));
}

TEST(SimplifiedFibers, StayWithinWhatAnAssemblyMayBe) {
  const double most = FiberAssembly::max_coordinate;
  const FiberAssembly thick({{0, 0, 0}, {1e149, 1e147, 0}, {2e149, 0, 0}}, {0, 3}, {most});
  SimplifiedFibers simplified;
  simplified.update(thick, 1e148);
  EXPECT_EQ(simplified.assembly().segment_count(), 2U);
  const FiberAssembly wide({{-most, 0, 0}, {0, most, 0}, {most, 0, 0}}, {0, 3}, {0.0});
  simplified.update(wide, 1e300);
  EXPECT_EQ(simplified.assembly().segment_count(), 2U);
  const FiberAssembly large({{-most, 0, 0}, {0, most / 2, 0}, {most, 0, 0}}, {0, 3}, {0.0});
  simplified.update(large, 1e300);
  EXPECT_EQ(simplified.assembly().segment_count(), 1U);
}

}  // namespace
}  // namespace fiber::test

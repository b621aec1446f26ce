#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "fiber_proximity/query/contact.hpp"
#include "test/support/answers.hpp"
#include "test/support/contacts.hpp"
#include "test/support/exact_distance.hpp"
#include "test/support/not_finite.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// The ends of two segments, a0, a1, b0 and b1 [m].
struct TwoSegments {
  Vector3d ends[4];

  Contact contact() const {
    const FiberAssembly fibers({ends[0], ends[1], ends[2], ends[3]}, {0, 2, 4}, {0.01});
    return brute_force(fibers, within(infinity, QueryType::CLOSEST)).contacts.front();
  }
  Wide distance() const { return exact_distance(ends[0], ends[1], ends[2], ends[3]); }
};

/// Of central differences in a hundred digits: the truth but for a part of 1e-12 or so.
Vector3d difference_quotient(const TwoSegments& segments, std::size_t end) {
  constexpr double step = 0x1p-24;
  Vector3d quotient;
  for (int axis = 0; axis < 3; ++axis) {
    TwoSegments more = segments;
    TwoSegments less = segments;
    more.ends[end][axis] += step;
    less.ends[end][axis] -= step;
    const Wide way = Wide(more.ends[end][axis]) - Wide(less.ends[end][axis]);
    quotient[axis] = static_cast<double>(Wide((more.distance() - less.distance()) / way));
  }
  return quotient;
}

TEST(GapGradient, IsWhatDifferencesOfExactDistancesTell) {
  SCOPED_TRACE(seed_message());
  Random random;
  int inside = 0;
  for (int round = 0; round < rounds(500); ++round) {
    TwoSegments segments;
    for (Vector3d& end : segments.ends) {
      end = random.in_cube();
    }
    const Contact contact = segments.contact();
    const Vector3d u = segments.ends[1] - segments.ends[0];
    const Vector3d v = segments.ends[3] - segments.ends[2];
    if (contact.distance < 0.05 || u.cross(v).norm() < 0.05 * u.norm() * v.norm()) {
      continue;  // differences are no derivatives near a kink
    }
    const GapGradient gradient = gradient_of(contact);
    const Vector3d parts[4] = {gradient.a0, gradient.a1, gradient.b0, gradient.b1};
    for (std::size_t end = 0; end < 4; ++end) {
      ASSERT_LT((parts[end] - difference_quotient(segments, end)).norm(), 1e-5)
          << "end " << end << " in round " << round;
    }
    inside += contact.s > 0.0 && contact.s < 1.0 && contact.t > 0.0 && contact.t < 1.0 ? 1 : 0;
  }
  expect_enough(inside, rounds(50));
}

TEST(GapGradient, MovingBothTogetherChangesNothing) {
  const TwoSegments segments{{{0, 0, 0}, {1, 0, 0}, {0.3, -1, 0.5}, {0.3, 1, 0.7}}};
  const GapGradient gradient = gradient_of(segments.contact());
  EXPECT_LT((gradient.a0 + gradient.a1 + gradient.b0 + gradient.b1).norm(), 1e-15);
  EXPECT_NEAR((gradient.b0 + gradient.b1).norm(), 1.0, 1e-15) << "away from each other";
}

}  // namespace
}  // namespace fiber::test

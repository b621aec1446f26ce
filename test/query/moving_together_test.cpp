// Fibres that are near each other move alike: run_tree keeps its tree and its candidates while they
// hardly move beside each other, however far all of them go. No answer may show that.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/hierarchy/motion_since_fit.hpp"
#include "src/query/run_tree_engine.hpp"
#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"
#include "test/support/query_options.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Displacements that grow from frame to frame: all go, stretch, shear, turn and wave.
class SmoothMotion {
 public:
  /// @param size [m] of the scene
  SmoothMotion(Random& random, double size)
      : step_(random.in_cube(random.chance(0.5) ? size : 0.01 * size)),
        wave_(random.in_cube(random.uniform(0.0, 0.02) * size)),
        direction_(random.in_cube(1.0) * (3.0 / std::max(size, 1e-100))) {
    const double strain = random.chance(0.3) ? 0.02 : 0.001;
    for (int axis = 0; axis < 3; ++axis) {
      strains_.col(axis) = random.in_cube(random.chance(0.3) ? 0.0 : strain);
    }
  }

  Vector3d at(const Vector3d& point, int frame) const {
    return point + frame * (step_ + strains_ * point + std::sin(direction_.dot(point)) * wave_);
  }

 private:
  Vector3d step_;
  Vector3d wave_;
  Vector3d direction_;
  Matrix3d strains_;
};

FiberAssembly moved(const FiberAssembly& first, const SmoothMotion& motion, int frame, double noise,
                    Random& random) {
  std::vector<Vector3d> points = first.points();
  for (Vector3d& point : points) {
    point = motion.at(point, frame) + random.in_cube(noise);
  }
  return with_points(first, points);
}

void expect_boxes_hold_fibers(const ProximityEngine& engine, const FiberAssembly& fibers) {
  for (const std::uint32_t level : {0U, 1U}) {
    std::vector<NodeBox> boxes;
    engine.level_boxes(level, boxes);
    for (const std::uint32_t point : segments_of(fibers)) {
      const Vector3d& place = fibers.points()[point];
      EXPECT_TRUE(std::any_of(boxes.begin(), boxes.end(), [&](const NodeBox& box) {
        return (place.array() >= box.lower.array()).all() &&
               (place.array() <= box.upper.array()).all();
      })) << level;
    }
  }
}

/// All types of queries, of all options, with others in between, and of shapes.
TEST(MovingTogether, AnswersAsBruteForce) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::uint64_t frames = 0;
  std::uint64_t served = 0;  // farther than the skin by itself lets them
  std::size_t found = 0;
  std::size_t found_with_shapes = 0;
  for (int round = 0; round < rounds(8); ++round) {
    for (const AssemblyFamily& family : assembly_families()) {
      SCOPED_TRACE(family.name);
      const FiberAssembly first = family.make(random);
      const double size = extent_of(first);
      const SmoothMotion motion(random, size);
      const double skin = size * random.uniform(0.0, 0.2);
      RunTreeEngine engine({random.integer(1, 2) == 1 ? 1U : 2U, skin});
      QueryOptions options = random_options(random, size);
      options.type = QueryType::ALL;
      FiberAssembly fibers = first;
      FiberAssembly fitted = first;
      std::uint64_t refits = 0;
      for (int frame = 0; frame < 8; ++frame) {
        fibers.update_points(moved(first, motion, frame, 0.01 * skin, random).points());
        engine.update(fibers);
        if (engine.refit_count() > refits) {
          refits = engine.refit_count();
          fitted = fibers;
        }
        double farthest = 0.0;
        for (std::size_t i = 0; i < fibers.point_count(); ++i) {
          farthest = std::max(farthest, (fibers.points()[i] - fitted.points()[i]).norm());
        }
        served += 2.0 * farthest > 1.01 * skin ? 1 : 0;
        ++frames;
        const QueryResult truth = brute_force(fibers, options);
        ASSERT_TRUE(same_contacts(answer(engine, options).contacts, truth.contacts)) << frame;
        found += truth.contacts.size();
        QueryOptions others = random_options(random, size);
        others.type = random.chance(0.5) ? QueryType::CLOSEST : QueryType::FIBER_PAIRS;
        EXPECT_TRUE(
            same_contacts(answer(engine, others).contacts, brute_force(fibers, others).contacts))
            << frame;
        const Vector3d near =
            fibers.point_count() == 0
                ? Vector3d::Zero()
                : fibers.points()[random.integer(0, static_cast<int>(fibers.point_count()) - 1)];
        const FiberAssembly shape =
            as_fibers({{near, near + random.in_cube(0.1 * size)}}, 0.02 * size);
        for (const QueryType type : {QueryType::ALL, QueryType::CLOSEST}) {
          const QueryOptions of_shape = within(0.05 * size, type);
          const QueryResult of_all = brute_force(shape, fibers, of_shape);
          EXPECT_TRUE(same_contacts(answer(engine, shape, of_shape).contacts, of_all.contacts));
          found_with_shapes += of_all.contacts.size();
        }
        expect_boxes_hold_fibers(engine, fibers);
      }
    }
  }
  expect_enough(served, frames / 10);
  expect_enough(found, std::size_t{1001});
  expect_enough(found_with_shapes, std::size_t{1001});
}

/// A bundle that is carried: farther in each frame than its skin is thick.
TEST(MovingTogether, KeepsTheTreeOfWhatIsCarried) {
  Random random(3);
  const FiberAssembly first = walks(random, 40, 30, 0.05, 0.02);
  FiberAssembly fibers = first;
  RunTreeEngine engine({1, 0.01});
  std::size_t found = 0;
  for (int frame = 0; frame < 20; ++frame) {
    std::vector<Vector3d> points = first.points();
    for (Vector3d& point : points) {
      point += 0.1 * frame * Vector3d(1.0, -2.0, 0.5);
    }
    fibers.update_points(points);
    engine.update(fibers);
    const QueryResult truth = brute_force(fibers);
    EXPECT_TRUE(same_contacts(answer(engine).contacts, truth.contacts));
    found += truth.contacts.size();
  }
  EXPECT_EQ(engine.refit_count(), 1U);
  EXPECT_GT(found, 100U);
}

void expect_contacts(const ProximityEngine& engine, const FiberAssembly& fibers,
                     const QueryOptions& options, std::size_t least) {
  const QueryResult truth = brute_force(fibers, options);
  EXPECT_GE(truth.contacts.size(), least);
  EXPECT_TRUE(same_contacts(answer(engine, options).contacts, truth.contacts));
}

/// Rows of fibres of ten segments, so far apart that none touch.
std::vector<std::vector<Vector3d>> rows(int count, double distance) {
  std::vector<std::vector<Vector3d>> fibers;
  for (int i = 0; i < count; ++i) {
    std::vector<Vector3d> points;
    for (int j = 0; j <= 10; ++j) {
      points.emplace_back(0.1 * j, distance * i, 0.0);
    }
    fibers.push_back(points);
  }
  return fibers;
}

/// All are carried, and two come towards each other beside that.
TEST(MovingTogether, SeesTwoThatComeTowardsEachOtherOnTheWay) {
  constexpr double skin = 0.1;
  const auto frame = [&](double carried, double each) {
    std::vector<std::vector<Vector3d>> fibers = rows(30, 1.0);
    fibers[10][5].z() += 0.75 * skin - each;
    fibers[11][5] = fibers[10][5];
    fibers[11][5].z() += -1.5 * skin + 2.0 * each;
    fibers[11][4] = fibers[11][5] - Vector3d(0.3, 0.0, 0.0);
    fibers[11][6] = fibers[11][5] + Vector3d(0.3, 0.1, 0.0);
    for (std::vector<Vector3d>& points : fibers) {
      for (Vector3d& point : points) {
        point += Vector3d(0.0, carried, carried);
      }
    }
    return as_fibers(fibers, 0.0);
  };
  for (const double each : {0.3, 0.49, 0.51, 0.6, 0.75}) {
    SCOPED_TRACE(each);
    RunTreeEngine engine({1, skin});
    QueryOptions options = within(0.001);
    options.pairing = Pairing::DIFFERENT_FIBERS;
    const FiberAssembly before = frame(0.0, 0.0);
    engine.update(before);
    answer(engine, options);
    const FiberAssembly fibers = frame(10.0 * skin, each * skin);
    engine.update(fibers);
    EXPECT_EQ(engine.refit_count(), each < 0.4 ? 1U : 2U);
    expect_contacts(engine, fibers, options, each == 0.75 ? 1U : 0U);
  }
}

/// Candidates of one margin are kept while they serve that one: not another one.
TEST(MovingTogether, SeesThatAWiderMarginNeedsMore) {
  constexpr double margin = 5.0;
  constexpr double skin = 0.03;
  const auto frame = [&](double scale) {
    std::vector<std::vector<Vector3d>> fibers(2);
    for (int i = 0; i < 2000; ++i) {
      fibers[0].push_back(scale * Vector3d(0.002 * i, 0.0, 0.0));
      fibers[1].push_back(scale * Vector3d(0.002 * i, 0.0, margin + 1.3 * skin));
    }
    return as_fibers(fibers, 0.0);
  };
  RunTreeEngine engine({1, skin});
  const FiberAssembly before = frame(1.0);
  engine.update(before);
  answer(engine, within(0.0));
  const FiberAssembly fibers = frame(0.99);
  engine.update(fibers);
  EXPECT_EQ(engine.refit_count(), 1U);
  QueryOptions options = within(margin);
  options.pairing = Pairing::DIFFERENT_FIBERS;
  expect_contacts(engine, fibers, options, 1000);
}

/// Short fibres rise in the middle of a carpet, to one long fibre above them whose ends stay: all
/// points move as the field does, but what is between the ends does not.
TEST(MovingTogether, SeesWhatIsBetweenTheEndsOfALongSegment) {
  constexpr double height = 0.05;
  const auto carpet = [&](double rise) {
    std::vector<std::vector<Vector3d>> fibers;
    for (int i = 0; i <= 42; ++i) {
      std::vector<Vector3d> points;
      for (int j = 0; j <= 42; ++j) {
        const double x = i / 42.0;
        points.emplace_back(x, j / 42.0, rise * std::min({3.0 * x, 1.0, 3.0 - 3.0 * x}));
      }
      fibers.push_back(points);
    }
    fibers.push_back({{0.0, 0.5, height}, {1.0, 0.5, height}});
    return as_fibers(fibers, 0.001);
  };
  QueryOptions options;
  options.pairing = Pairing::DIFFERENT_FIBERS;
  RunTreeEngine engine({1, 0.03});
  const FiberAssembly before = carpet(0.0);
  engine.update(before);
  expect_contacts(engine, before, options, 0);
  const FiberAssembly fibers = carpet(0.0485);
  engine.update(fibers);
  expect_contacts(engine, fibers, options, 10);
}

/// Thick fibres that all come together, as far as the skin lets them and a little farther: their
/// axes are far from each other where their surfaces are near.
TEST(MovingTogether, SeesThatThickFibersComeTogether) {
  std::size_t found = 0;
  for (const double skin : {0.05, 0.2}) {
    for (double shrunk = 0.0; shrunk < 0.1; shrunk += 0.002) {
      const auto stack = [&](double scale) {
        std::vector<std::vector<Vector3d>> fibers;
        for (int i = 0; i < 30; ++i) {
          std::vector<Vector3d> points;
          for (int j = 0; j <= 10; ++j) {
            points.emplace_back(scale * 0.1 * j, scale * (1.0 + 1.02 * skin) * i, 0.0);
          }
          fibers.push_back(points);
        }
        return as_fibers(fibers, 0.5);
      };
      RunTreeEngine engine({1, skin});
      QueryOptions options;
      options.pairing = Pairing::DIFFERENT_FIBERS;
      for (const double scale : {1.0, 1.0 - shrunk}) {
        const FiberAssembly fibers = stack(scale);
        engine.update(fibers);
        const QueryResult truth = brute_force(fibers, options);
        EXPECT_TRUE(same_contacts(answer(engine, options).contacts, truth.contacts))
            << skin << ", " << shrunk;
        found += truth.contacts.size();
      }
    }
  }
  EXPECT_GT(found, 1000U);
}

TEST(Approach, IsWhatPointsOfAFieldWereApartAtMost) {
  // Points at 0 and 1 of a field that shrinks everything to 0.9, radii of 0.2.
  const Approach shrinking(0.0, 0.1, 0.4);
  EXPECT_GE(shrinking.before(0.5), 0.6 - 1e-15);
  EXPECT_LE(shrinking.before(0.5), 0.6 + 1e-12);
  // Two points that come nearer by 0.3 together beside each other.
  EXPECT_NEAR(Approach(0.3, 0.0, 0.4).before(0.1), 0.4, 1e-12);
  EXPECT_NEAR(Approach(0.3).before(0.1), 0.4, 0.0);
  EXPECT_EQ(Approach(0.0, 1.0, 0.4).before(0.1), std::numeric_limits<double>::infinity());
  EXPECT_EQ(Approach(0.0, std::numeric_limits<double>::quiet_NaN(), 0.4).before(0.1),
            std::numeric_limits<double>::infinity());
  EXPECT_TRUE(Approach().is_none());
}

}  // namespace
}  // namespace fiber::test

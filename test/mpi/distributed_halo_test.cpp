// What ranks hold: their share, and of others what may be near.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "src/mpi/box_tree.hpp"
#include "src/mpi/local_fibers.hpp"
#include "src/mpi/piece_capsule.hpp"
#include "test/mpi/scattered_fibers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"

namespace fiber::test {
namespace {

/// A soup of short fibres, scattered out fibre by fibre as they come; the first may be thick.
struct Soup {
  explicit Soup(double first_radius) {
    AssemblyBuilder builder;
    std::vector<double> radii(2000, 1e-5);
    radii[0] = first_radius;
    Random random;
    for (std::size_t fiber = 0; fiber < radii.size(); ++fiber) {
      builder.add_fiber(random_walk(random, 5, 0.01));
    }
    fibers = builder.build(radii);
    const DistributedFibers mine = scattered_to(own_rank(), fibers, scatter(fibers, 1, random));
    engine.update(mine.parts, mine.names);
  }

  FiberAssembly fibers;
  DistributedEngine engine{MPI_COMM_WORLD, one_thread()};
};

TEST(DistributedHalo, SharesAreAboutEqual) {
  Soup soup(1e-5);
  const std::uint64_t own = soup.engine.facts().own_segments;
  EXPECT_EQ(over_ranks(own, MPI_SUM), soup.fibers.segment_count());
  const double share =
      static_cast<double>(soup.fibers.segment_count()) / static_cast<double>(rank_count());
  EXPECT_LE(static_cast<double>(over_ranks(own, MPI_MAX)), 1.1 * share + 16.0);
}

/// Fibres that touch nothing, and as many that all but fill their place, in turn.
FiberAssembly sparse_and_dense(Random& random) {
  AssemblyBuilder builder;
  for (std::size_t fiber = 0; fiber < 1200; ++fiber) {
    const bool is_dense = fiber % 2 == 0;
    std::vector<Eigen::Vector3d> points = random_walk(random, 33, 0.02);
    const Eigen::Vector3d start = points.front();
    for (Eigen::Vector3d& point : points) {
      point += is_dense ? Eigen::Vector3d(-0.97 * start)
                        : Eigen::Vector3d(9.0 * start + Eigen::Vector3d(100.0, 0.0, 0.0));
    }
    builder.add_fiber(points);
  }
  return builder.build({1e-5});
}

/// Updates of the same fibres, until all ranks have as much to do.
void expect_shared_out(const FiberAssembly& fibers, Random& random) {
  const DistributedFibers mine = scattered_to(own_rank(), fibers, scatter(fibers, 1, random));
  const std::vector<Contact> expected = answer("run_tree", fibers, within(0.02)).contacts;
  ASSERT_GT(expected.size(), 2 * fibers.segment_count());
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  std::vector<double> most_of_mean;
  for (int frame = 0; frame < 4; ++frame) {
    engine.update(mine.parts, mine.names, mine.topology);
    DistributedResult result;
    engine.query(within(0.02), result);
    const auto most = static_cast<double>(over_ranks(result.contacts.size(), MPI_MAX));
    most_of_mean.push_back(most * rank_count() / static_cast<double>(expected.size()));
    ASSERT_TRUE(same_as_one_process(gather(MPI_COMM_WORLD, result), expected)) << "frame " << frame;
  }
  if (rank_count() == 2) {
    EXPECT_GT(most_of_mean.front(), 1.8) << "first as many segments are taken for as much work";
  }
  if (rank_count() > 1) {
    EXPECT_GT(engine.facts().split_count, 1U);
    EXPECT_LT(most_of_mean.back(), 1.3);
  }
  EXPECT_LT(engine.facts().split_count, 4U) << "what was evened out is left alone";
}

TEST(DistributedHalo, CostsAreSharedOutWhereTheyAre) {
  Random random;
  expect_shared_out(sparse_and_dense(random), random);
}

/// Each dense fibre with the next dense one, two by two: what is joined goes to other owners, too.
TEST(DistributedHalo, CostsOfJoinedFibersAreSharedOutWhereTheyAre) {
  Random random;
  const FiberAssembly chains = sparse_and_dense(random);
  FiberTopology topology;
  topology.joint_tolerance = std::numeric_limits<double>::infinity();
  topology.joints.assign(chains.point_count(), -1);
  for (std::uint32_t fiber = 0; fiber < chains.fiber_count(); fiber += 2) {
    topology.joints[chains.offsets()[fiber]] = static_cast<std::int32_t>(fiber / 4);
  }
  expect_shared_out({chains.points(), chains.offsets(), chains.radii(), topology}, random);
}

TEST(DistributedHalo, OnlyWhatIsNearComes) {
  Soup soup(1e-5);
  const DistributedResult found = answer(soup.engine, within(1e-3));
  EXPECT_TRUE(same_as_one_process(found, answer("run_tree", soup.fibers, within(1e-3)).contacts));
  const std::uint64_t halo = over_ranks(soup.engine.facts().halo_segments, MPI_SUM);
  EXPECT_EQ(halo == 0, rank_count() == 1);
  EXPECT_LE(halo, soup.fibers.segment_count() / 5);
}

TEST(DistributedHalo, AThickFibreBringsNoMoreThanWhatIsNearIt) {
  Soup thin(1e-5);
  Soup thick(0.1);  // ten thousand times as thick as the others
  const DistributedResult found = answer(thick.engine, within(1e-3));
  answer(thin.engine, within(1e-3));
  const QueryResult expected = answer("run_tree", thick.fibers, within(1e-3));
  EXPECT_TRUE(same_as_one_process(found, expected.contacts));
  const std::uint64_t more = over_ranks(thick.engine.facts().halo_segments, MPI_SUM);
  const std::uint64_t few = over_ranks(thin.engine.facts().halo_segments, MPI_SUM);
  // Each contact of the thick one brings one segment at most; boxes are somewhat larger.
  EXPECT_LE(more, few + expected.contacts.size() * 2);
}

/// The fibres, each point moved by up to this [m] along each axis; some thick ones go on and on. At
/// times one more is thick.
FiberAssembly stirred(const FiberAssembly& fibers, double step, Random& random) {
  std::vector<Eigen::Vector3d> points = fibers.points();
  for (std::size_t p = 0; p < points.size(); ++p) {
    points[p] += p < fibers.offsets()[10] ? Eigen::Vector3d(0.003, 0.002, -0.001)
                                          : Eigen::Vector3d(step * random.in_cube());
  }
  std::vector<double> radii(fibers.fiber_count(), 0.002);
  std::fill_n(radii.begin(), 10, 0.04);
  radii.back() = random.chance(0.05) ? 0.04 : 0.002;
  return {std::move(points), fibers.offsets(), std::move(radii)};
}

TEST(DistributedHalo, ServesWhilePointsMoveLittle) {
  Random random;
  int searches = 0;
  int frames = 0;
  for (int scene = 0; scene < 8; ++scene) {
    FiberAssembly fibers = walks(random, 300, 20, 0.05, 0.002);
    const std::vector<ScatteredPart> scattered = scatter(fibers, 2, random);
    DistributedEngine engine(MPI_COMM_WORLD, one_thread());
    const QueryOptions options = within(scene % 2 == 0 ? 0.0 : 0.003);
    for (int frame = 0; frame < 20; ++frame, ++frames) {
      const DistributedFibers mine = scattered_to(own_rank(), fibers, scattered);
      engine.update(mine.parts, mine.names);
      ASSERT_TRUE(same_as_one_process(answer(engine, options),
                                      answer("run_tree", fibers, options).contacts))
          << "scene " << scene << ", frame " << frame;
      fibers = stirred(fibers, 1e-4, random);
    }
    searches += static_cast<int>(engine.facts().halo_search_count);
  }
  if (rank_count() == 1) {
    EXPECT_EQ(searches, 0);
  } else {
    EXPECT_GT(searches, 3 * 8) << "what was found must not serve for ever";
    EXPECT_LT(searches, frames * 3 / 4) << "nor be looked for every time";
  }
}

/// Two layers of lines, one above the other and half a line's piece beside it.
FiberAssembly layers(double gap) {
  AssemblyBuilder builder;
  for (int line = 0; line < 80; ++line) {
    const bool is_upper = line % 2 == 1;
    for (int point = 0; point <= 40; ++point) {
      builder.add_point({0.025 * point + (is_upper ? 0.06 : 0.0), is_upper ? gap : 0.0,
                         0.05 * static_cast<double>(line / 2)});
    }
    builder.end_fiber();
  }
  return builder.build({0.002});
}

/// What is far apart comes as fast towards each other as all points move, until it touches.
TEST(DistributedHalo, ServesNoLongerThanUntilTwoMayMeet) {
  Random random;
  constexpr int frames = 30;
  constexpr double step = 3e-4;  // [m] that each layer moves
  const auto at_frame = [](int frame) { return layers(0.018 - 2.0 * step * frame); };
  const std::vector<ScatteredPart> scattered = scatter(at_frame(0), 2, random);
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  std::size_t contacts = 0;
  for (int frame = 0; frame < frames; ++frame) {
    FiberAssembly fibers = at_frame(frame);
    std::vector<Eigen::Vector3d> points = fibers.points();
    for (Eigen::Vector3d& point : points) {
      point.y() += step * frame;
    }
    fibers = FiberAssembly(std::move(points), fibers.offsets(), fibers.radii());
    const DistributedFibers mine = scattered_to(own_rank(), fibers, scattered);
    engine.update(mine.parts, mine.names);
    const QueryResult expected = answer("run_tree", fibers, within(0.0));
    contacts = expected.contacts.size();
    ASSERT_TRUE(same_as_one_process(answer(engine, within(0.0)), expected.contacts))
        << "frame " << frame;
  }
  EXPECT_GT(contacts, 1000U) << "they touch in the end";
  EXPECT_TRUE(rank_count() == 1 || engine.facts().halo_search_count < frames / 2);
}

/// A segment across an axis, so that boxes are as far apart as segments.
std::pair<FiberNode, FiberNode> across(double place, double radius) {
  return {{{place, -1e-3, 0.0}, radius}, {{place, 1e-3, 0.0}, 0.0}};
}

Box3d box_of(const FiberNode& start, const FiberNode& end) {
  return inflated(Box3d(start.point).extend(end.point), start.radius);
}

TEST(BoxTree, BoxesInSinglePrecisionHoldThoseInDouble) {
  Random random;
  std::vector<Box3d> boxes;
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3d corner = random.in_cube();
    boxes.push_back(Box3d(corner).extend(corner + 0.1 * random.in_cube()));
  }
  const BoxTree tree(boxes);
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    ASSERT_TRUE(tree.box(i).contains(boxes[i])) << i;
  }
}

TEST(DistributedHalo, BoxesThatAreApartAlongAnyAxisDoNotMeet) {
  const Box3d box(Eigen::Vector3d(1.0, 2.0, 3.0), Eigen::Vector3d(2.0, 3.0, 4.0));
  const BoxTree tree(std::vector<Box3d>{box});
  for (int axis = 0; axis < 3; ++axis) {
    for (const double way : {-1.1, -0.9, 0.9, 1.1}) {
      const Eigen::Vector3d moved = way * Eigen::Vector3d::Unit(axis);
      const Box3d other = box.translated(moved);
      EXPECT_EQ(tree.meets(0, tree.seen_from_origin(other)), std::abs(way) < 1.0)
          << way << " along " << axis;
    }
  }
}

TEST(DistributedHalo, BoxesAreNoFurtherApartThanSegmentsAreFound) {
  Random random;
  for (int round = 0; round < 20000; ++round) {
    const double near = random.uniform(-1.0, 1.0) * std::pow(10.0, random.integer(-6, 0));
    const double far = near + random.uniform(0.5, 2.0);
    const auto [a0, a1] = across(near, random.uniform(0.0, 0.2));
    const auto [b0, b1] = across(far, random.uniform(0.0, 0.2));
    const SegmentDistance nearest = segment_distance(a0.point, a1.point, b0.point, b1.point);
    const double gap = nearest.distance - (a0.radius + b0.radius);
    ASSERT_TRUE(may_come_within(box_of(a0, a1), box_of(b0, b1), gap)) << gap;
    ASSERT_FALSE(may_come_within(box_of(a0, a1), box_of(b0, b1), gap - 1e-12)) << gap;
  }
}

/// One run of segments that all have this radius [m].
LocalFibers run_of(const std::vector<Eigen::Vector3d>& points, double radius) {
  FiberRuns set;
  set.runs.push_back({{7, 3}, points.size() - 1, 0, 0.0});
  for (const Eigen::Vector3d& point : points) {
    set.nodes.push_back({point, radius});
  }
  LocalFibers fibers;
  fibers.assign(set);
  return fibers;
}

TEST(DistributedHalo, ABallIsAroundItsSegmentOnAllOfItsWay) {
  Random random;
  for (int round = 0; round < 1000; ++round) {
    const LocalFibers before = run_of(random_walk(random, 1, 0.2), 0.01);
    const LocalFibers after = run_of(random_walk(random, 1, random.uniform(0.1, 3.0)), 0.02);
    const SegmentBall ball = ball_around({before, &after}, 0);
    for (const LocalFibers* fibers : {&before, &after}) {
      for (const Eigen::Vector3d& point : fibers->fibers().points()) {
        ASSERT_LE((point - ball.centre).norm() + fibers->fibers().segment_radius(0),
                  ball.radius * (1.0 + 1e-12));
      }
    }
  }
}

TEST(DistributedHalo, WhatIsNearIsNearTheCapsuleAroundIt) {
  Random random;
  int apart = 0;
  for (int round = 0; round < 3000; ++round) {
    const double scale = std::pow(10.0, random.chance(0.1) ? -200.0 : random.uniform(-6.0, 6.0));
    const Eigen::Vector3d offset =
        random.chance(0.5) ? 1e3 * scale * random.in_cube() : Eigen::Vector3d::Zero().eval();
    const auto walk = [&](int segments) {
      std::vector<Eigen::Vector3d> points = random_walk(random, segments, 0.2);
      for (Eigen::Vector3d& point : points) {
        point = scale * point + offset;
      }
      return points;
    };
    const auto radius = [&] { return scale * random.uniform(0.0, 0.05); };
    const int segments = random.integer(1, 8);
    const bool do_move = random.chance(0.5);
    const LocalFibers before = run_of(walk(segments), radius());
    const LocalFibers after = run_of(walk(segments), radius());
    const LocalFibers other = run_of(walk(1), radius());
    const FiberStates piece{before, do_move ? &after : nullptr};
    const PieceCapsule capsule = capsule_around(piece, 0, static_cast<std::uint64_t>(segments));
    const SegmentBall ball = ball_around({other}, 0);
    // On its way a segment is between where it is before and after it.
    const double part = do_move ? random.uniform(0.0, 1.0) : 0.0;
    double gap = std::numeric_limits<double>::infinity();
    const Capsule own = other.fibers().capsule(0);
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(segments); ++i) {
      const Capsule from = before.fibers().capsule(i);
      const Capsule to = after.fibers().capsule(i);
      const SegmentDistance nearest =
          segment_distance((1.0 - part) * from.p0 + part * to.p0,
                           (1.0 - part) * from.p1 + part * to.p1, own.p0, own.p1);
      gap = std::min(gap, nearest.distance - from.radius - own.radius);
    }
    ASSERT_TRUE(may_come_within(ball, capsule, std::max(gap, 0.0)))
        << gap << " m at scale " << scale;
    apart += may_come_within(ball, capsule, 0.1 * std::max(gap, 0.0)) ? 0 : 1;
  }
  EXPECT_GT(apart, 300) << "or all is near all";
}

}  // namespace
}  // namespace fiber::test

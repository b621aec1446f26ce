// Ranks that each have some of a fibre's points answer by the rule of LoopTest.
#include "src/mpi/loop_questions.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "fiber_proximity/query/for_engines/loop_test.hpp"
#include "test/mpi/scattered_fibers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/dense_fibers.hpp"
#include "test/support/hard_scenes.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

/// Stretches of one to seven segments, each for a rank that is drawn: those of this one, and some
/// of others that it knows.
void deal_runs(const FiberAssembly& fibers, Random& random, FiberRuns& own, FiberRuns& halo) {
  std::vector<FiberNode> nodes;
  for (std::uint32_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const std::uint32_t begin = fibers.offsets()[fiber];
    const std::uint32_t last = fibers.offsets()[fiber + 1] - 1;
    for (std::uint32_t first = begin; first < last;) {
      const auto drawn = static_cast<std::uint32_t>(random.integer(1, 7));
      const std::uint32_t count = std::min(drawn, last - first);
      const bool is_own = random.integer(0, rank_count() - 1) == own_rank();
      if (random.chance(0.3) || is_own) {
        nodes.clear();
        for (std::uint32_t p = first; p <= first + count; ++p) {
          nodes.push_back({fibers.points()[p], fibers.segment_radius(p)});
        }
        (is_own ? own : halo)
            .add({{name_of_fiber(fiber), first - begin}, count, 0, 0.0}, nodes.data());
      }
      first += count;
    }
  }
}

/// Some segments of one fibre that share no point, the first one first.
std::vector<PointPair> draw_pairs(const FiberAssembly& fibers, Random& random) {
  std::vector<PointPair> pairs;
  for (int i = 0; i < 50 && fibers.fiber_count() > 0; ++i) {
    const auto fiber =
        static_cast<std::size_t>(random.integer(0, static_cast<int>(fibers.fiber_count()) - 1));
    const std::uint32_t begin = fibers.offsets()[fiber];
    const auto segments = static_cast<int>(fibers.offsets()[fiber + 1] - begin - 1);
    const int a = random.integer(0, segments - 1);
    const int b =
        random.integer(a, random.chance(0.5) ? segments - 1 : std::min(a + 4, segments - 1));
    if (b - a > 1) {
      pairs.push_back(
          {begin + static_cast<std::uint32_t>(a), begin + static_cast<std::uint32_t>(b)});
    }
  }
  return pairs;
}

LoopQuestion question_about(const FiberAssembly& fibers, PointPair pair) {
  const SegmentId a = fibers.segment_id(pair.a);
  const SegmentId b = fibers.segment_id(pair.b);
  return {name_of_fiber(a.fiber), a.segment, b.segment, fibers.capsule(pair.a),
          fibers.capsule(pair.b)};
}

TEST(LoopQuestions, AreAnsweredAsByWhoHasAllPoints) {
  SCOPED_TRACE(seed_message());
  const Communicator ranks(MPI_COMM_WORLD);
  Random random;
  Random own_random(static_cast<std::uint64_t>(own_rank()) + 1);
  std::vector<AssemblyFamily> families = assembly_families();
  for (const std::vector<AssemblyFamily>& more : {dense_families(), hard_scenes()}) {
    families.insert(families.end(), more.begin(), more.end());
  }
  int loops = 0;
  int others = 0;
  for (const AssemblyFamily& family : families) {
    for (int round = 0; round < rounds(20); ++round) {
      const FiberAssembly fibers = family.make(random);
      FiberRuns own_runs;
      FiberRuns halo_runs;
      deal_runs(fibers, random, own_runs, halo_runs);
      LocalFibers own;
      own.assign(own_runs);
      LocalFibers halo;
      halo.assign(halo_runs);
      const std::vector<PointPair> pairs =
          draw_pairs(fibers, own_random);  // each rank asks its own
      std::vector<LoopQuestion> questions;
      for (const PointPair pair : pairs) {
        questions.push_back(question_about(fibers, pair));
      }
      const std::vector<bool> found = find_loops(ranks, own, halo, questions);
      const LoopTest test(fibers);
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        const Capsule a = fibers.capsule(pairs[i].a);
        const Capsule b = fibers.capsule(pairs[i].b);
        const bool expected = test.makes_loop(pairs[i], segment_distance(a.p0, a.p1, b.p0, b.p1));
        EXPECT_EQ(found[i], expected)
            << family.name << ", points " << pairs[i].a << " and " << pairs[i].b;
        (expected ? loops : others) += 1;
      }
    }
  }
  expect_enough(loops, 1000 / rounds_less);
  expect_enough(others, 1000 / rounds_less);
}

TEST(LoopQuestions, AreAboutThePointsAfterTheFirstSegmentUpToTheLast) {
  FiberRuns runs;
  runs.add({{7, 3}, 5, 0, 0.0}, std::vector<FiberNode>(6).data());  // segments 3 to 7
  LocalFibers fibers;
  fibers.assign(runs);
  const KnownRuns known(fibers);
  const auto count = [&](std::uint64_t fiber, std::uint64_t a, std::uint64_t b) {
    LoopQuestion question;
    question.fiber = fiber;
    question.segment_a = a;
    question.segment_b = b;
    return known.count(question);
  };
  EXPECT_EQ(count(7, 3, 6), 3U);
  EXPECT_EQ(count(7, 0, 3), 1U);
  EXPECT_EQ(count(7, 6, 20), 1U);
  EXPECT_EQ(count(7, 0, 20), 5U);
  EXPECT_EQ(count(7, 0, 2), 0U);
  EXPECT_EQ(count(7, 7, 9), 0U);
  EXPECT_EQ(count(6, 0, 20), 0U);
}

}  // namespace
}  // namespace fiber::test

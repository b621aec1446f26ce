#include "src/mpi/plan.hpp"

#include <gtest/gtest.h>
#include <mpi.h>

#include <cmath>
#include <vector>

#include "fiber_proximity/scenes/large_scene.hpp"
#include "src/mpi/fiber_runs.hpp"
#include "test/mpi/dealt_fibers.hpp"
#include "test/support/contacts.hpp"

namespace fiber::test {
namespace {

/// Parts of n segments whose halos follow the law, but for roundings; one has twice the others'.
std::vector<PartLoad> parts_by_law(double segments, double linear, double quadratic) {
  const double x = 1.0 / std::sqrt(segments);
  const double halo = segments * (linear * x + quadratic * x * x);
  std::vector<PartLoad> loads(3);
  for (PartLoad& load : loads) {
    load.segments = static_cast<std::uint64_t>(segments);
    load.halo_segments = static_cast<std::uint64_t>(std::lround(0.75 * halo));
    load.halo_runs = load.halo_segments / 3;
    load.neighbours = 2;
  }
  loads[1].halo_segments *= 2;
  return loads;
}

TEST(HaloLaw, GoesOnAsTheSamplesDo) {
  const std::vector<PartLoad> large = parts_by_law(1e6, 20.0, 300.0);
  const HaloLaw law(large, parts_by_law(1e4, 20.0, 300.0), 2);
  for (const double segments : {1e4, 1e6, 1e8, 1e10}) {
    const double x = 1.0 / std::sqrt(segments);
    EXPECT_NEAR(law.share(segments), 20.0 * x + 300.0 * x * x, 1e-4 * 20.0 * x) << segments;
  }
  const std::vector<PlannedPart> parts = grown(plan_of(large), law, 1e8);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    EXPECT_DOUBLE_EQ(parts[i].segments, 1e8);
    EXPECT_NEAR(parts[i].halo_segments, (i == 1 ? 1.5 : 0.75) * 1e8 * law.share(1e8), 1.0);
    EXPECT_EQ(parts[i].neighbours, 2.0);
  }
}

TEST(HaloLaw, OfNoHalosIsNone) {
  const HaloLaw law(parts_by_law(1e6, 0.0, 0.0), parts_by_law(1e4, 0.0, 0.0), 3);
  EXPECT_EQ(law.share(1e9), 0.0);
  for (const PlannedPart& part : grown(plan_of(parts_by_law(1e6, 0.0, 0.0)), law, 1e9)) {
    EXPECT_EQ(part.halo_segments, 0.0);
    EXPECT_EQ(part.segments, 1e9);
  }
}

TEST(Plan, StepsTakeWhatTheirPartsTake) {
  std::vector<PlannedPart> parts(2);
  for (PlannedPart& part : parts) {
    part.segments = 1e6;
    part.halo_segments = 1e5;
    part.halo_bytes = 4e6;
    part.neighbours = 10.0;
  }
  parts[1].halo_segments = 3e5;
  predict_steps(parts, {0.9e-6, 1e-6}, {1e9, 1e-3});
  const double bytes = 1e6 * sizeof(FiberNode) * 17.0 / 16.0 + 4e6;
  EXPECT_DOUBLE_EQ(parts[0].bytes, bytes);
  EXPECT_DOUBLE_EQ(parts[0].seconds, 1.1 + bytes / 1e9 + 0.01);
  EXPECT_DOUBLE_EQ(parts[1].seconds, 1.3 + bytes / 1e9 + 0.01);
  EXPECT_DOUBLE_EQ(parts[1].efficiency, 0.9 / parts[1].seconds);
  predict_steps(parts, {0.9e-6, 1e-6}, {1e9, 1e-3, true});
  EXPECT_DOUBLE_EQ(parts[0].bytes, 4e6) << "of what is adopted only halos travel";
  EXPECT_DOUBLE_EQ(parts[0].seconds, 1.1 + 4e-3 + 0.01);
}

/// All of it, on the first rank.
DistributedFibers soup_of(std::uint64_t segments, std::uint64_t number) {
  DistributedFibers fibers;
  if (own_rank() == 0) {
    const LargeScene scene = make_large_scene("soup", segments, number + 1);
    fibers.parts = scene.fibers(0, scene.fiber_count, 0);
    for (std::uint64_t fiber = 0; fiber < scene.fiber_count; ++fiber) {
      fibers.names.push_back({fiber, 0});
    }
  }
  return fibers;
}

TEST(ScenePlan, ForetellsASoupThatIsTenTimesAsLarge) {
  const Communicator ranks(MPI_COMM_WORLD);
  for (const int parts : {2, 4, 8}) {
    const ScenePlan plan = sample_scene(ranks, soup_of, 60'000, parts, 1e-3, 3);
    double halo = 0.0;
    for (const PartLoad& load : part_loads(ranks, soup_of(600'000, 99), parts, 1e-3)) {
      halo += static_cast<double>(load.halo_segments);
    }
    EXPECT_NEAR(plan.law.share(600'000.0 / parts) / (halo / 600'000.0), 1.0, 0.15)
        << parts << " parts";
  }
}

}  // namespace
}  // namespace fiber::test

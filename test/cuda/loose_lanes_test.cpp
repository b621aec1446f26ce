// Kernels whose lanes go on by themselves, as the threads of a GPU do, until they have to meet:
// what compute-sanitizer's racecheck looks for on a GPU, where there is none.
#include "test/support/loose_lanes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "fiber_proximity/cuda/device_proximity.hpp"
#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/candidate_batch.hpp"
#include "test/support/contacts.hpp"
#include "test/support/device_arrays.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

std::unique_ptr<Device> make_loose_device(const std::shared_ptr<LooseExecutor>& executor) {
  return std::make_unique<DeviceOf<LooseExecutor>>(executor);
}

/// Each lane writes, and reads what the next one has written, with and without meeting it between.
struct ReadNext {
  struct Scratch {
    int written[warp_width];
  };
  bool meets;
  bool lane_0_leaves;
  std::vector<int>* read;

  template <class Warp>
  void operator()(Warp warp, std::uint32_t index, Scratch& scratch) const {
    warp.each([&](int lane) { scratch.written[lane] = lane; });
    if (meets) {
      warp.sync();
    }
    bool leaves = false;
    warp.each([&](int lane) {
      (*read)[index * warp_width + static_cast<std::uint32_t>(lane)] =
          scratch.written[(lane + 1) % warp_width];
      leaves = lane_0_leaves && lane == 0;
    });
    if (!leaves) {
      warp.sync();
    }
  }
};

TEST(LooseLanes, ShowWhatHasNotBeenWaitedFor) {
  SCOPED_TRACE(seed_message());
  Random random;
  constexpr std::uint32_t warp_count = 20;
  for (const bool meets : {true, false}) {
    for (const bool leaves : {false, true}) {
      LooseExecutor executor(random);
      std::vector<int> read(std::size_t{warp_count} * warp_width);
      const LooseExecutor::Turn turn(executor);
      executor.for_each_warp(warp_count, ReadNext{meets, leaves, &read});
      std::size_t wrong = 0;
      for (std::size_t i = 0; i < read.size(); ++i) {
        wrong += read[i] == static_cast<int>((i + 1) % warp_width) ? 0U : 1U;
      }
      EXPECT_EQ(wrong > 0, !meets);
      EXPECT_EQ(executor.stuck_count(), leaves ? static_cast<int>(warp_count) : 0);
    }
  }
}

TEST(LooseLanes, FindTheSameContacts) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::size_t count = 0;
  for (int round = 0; round < rounds(3); ++round) {
    for (const AssemblyFamily& family : assembly_families()) {
      const FiberAssembly fibers = family.make(random);
      if (fibers.point_count() == 0) {
        continue;
      }
      SCOPED_TRACE(family.name);
      const auto executor = std::make_shared<LooseExecutor>(random);
      DeviceProximity device(make_loose_device(executor), fibers.offsets(), fibers.radii());
      device.update_from_host(fibers.points());
      const DeviceProximity::Options options = random_device_options(random, fibers);
      const std::vector<Contact> expected =
          answer("run_tree", fibers, same_query(options)).contacts;
      DeviceArrays arrays;
      expect_same(arrays, device.query(options), fibers, expected);
      ASSERT_EQ(executor->stuck_count(), 0);
      if (HasFatalFailure()) {
        return;
      }
      count += expected.size();
    }
  }
  EXPECT_GT(count, 1000U);
}

/// Of candidates that other warps mark while this one looks.
TEST(LooseLanes, CheckCandidatesAlike) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::ptrdiff_t touching = 0;
  std::ptrdiff_t free = 0;
  for (int round = 0; round < rounds(20); ++round) {
    std::vector<FiberAssembly> candidates;
    for (int i = 0; i < 6; ++i) {
      candidates.push_back(random.chance(0.3) ? coil(random)
                                              : walks(random, 4, random.integer(20, 80), 0.05,
                                                      random.uniform(0.001, 0.03)));
    }
    const CandidateBatch batch(candidates, walks(random, 2, 30, 0.05, 0.004));
    std::vector<std::uint8_t> expected;
    std::vector<std::uint8_t> found;
    const DeviceProximity::Options options{
        0.0, random.chance(0.5) ? std::optional<std::uint32_t>() : 1, Pairing::ALL};
    DeviceProximity host(make_host_device(), batch.offsets, batch.radii, batch.begins);
    host.update_from_host(batch.points);
    host.check_candidates(options, expected);
    const auto executor = std::make_shared<LooseExecutor>(random);
    DeviceProximity device(make_loose_device(executor), batch.offsets, batch.radii, batch.begins);
    device.update_from_host(batch.points);
    device.check_candidates(options, found);
    EXPECT_EQ(found, expected);
    ASSERT_EQ(executor->stuck_count(), 0);
    touching += std::count(expected.begin(), expected.end(), 1);
    free += std::count(expected.begin(), expected.end(), 0);
  }
  EXPECT_GT(touching, 0);
  EXPECT_GT(free, 0);
}

}  // namespace
}  // namespace fiber::test

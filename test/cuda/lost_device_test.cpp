// Devices that fail: lost for good in the middle of something, as a GPU is after an access to
// memory that is not its own, or once, as where memory does not suffice. Whichever call it is that
// fails.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "fiber_proximity/cuda/device_proximity.hpp"
#include "src/cuda/cuda_tree_engine.hpp"
#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/candidate_batch.hpp"
#include "test/support/contacts.hpp"
#include "test/support/device_arrays.hpp"
#include "test/support/failing_device.hpp"
#include "test/support/random.hpp"

namespace fiber::test {
namespace {

FiberAssembly some_fibers() {
  Random random;
  return walks(random, 6, 40, 0.05, 0.03);
}

/// Calls with numbers of calls from 0 on, until there are no more than so many.
/// @param use makes what it works with, and lets it go
void for_each_failure(bool is_for_good, const std::function<void()>& use) {
  int failed = 0;
  for (int calls_before = 0;; ++calls_before) {
    SCOPED_TRACE("call " + std::to_string(calls_before));
    will_fail(calls_before, is_for_good);
    use();
    ASSERT_FALSE(testing::Test::HasFailure());
    ASSERT_EQ(fault.buffers, 0);
    if (!fault.has_failed) {
      break;
    }
    ++failed;
  }
  EXPECT_GT(failed, 40);
  will_not_fail();
}

/// Calls, and holds what is thrown against what a device throws.
/// @return whether nothing was
bool succeeds(const std::function<void()>& step) {
  try {
    step();
    return true;
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), lost_error);
    return false;
  }
}

TEST(LostDevice, EveryCallOfTheEngineTellsOfIt) {
  const FiberAssembly fibers = some_fibers();
  QueryOptions options = within(0.01);
  options.neighbour_skip = 1;
  const QueryResult expected = brute_force(fibers, options);
  ASSERT_GT(expected.contacts.size(), 100U);
  for_each_failure(true, [&] {
    std::unique_ptr<ProximityEngine> engine;
    QueryResult result;
    const bool is_there = succeeds(
        [&] { engine = std::make_unique<CudaTreeEngine>(make_failing_device(), EngineOptions{}); });
    if (!is_there) {
      return;
    }
    for (int frame = 0; frame < 2; ++frame) {
      const bool is_updated = succeeds([&] { engine->update(fibers); });
      EXPECT_TRUE(is_updated != fault.has_failed);
      if (!is_updated) {
        // Nothing of it answers: no contacts would be a wrong answer.
        EXPECT_THROW(engine->query(options, result), std::logic_error);
        continue;
      }
      if (succeeds([&] { engine->query(options, result); })) {
        EXPECT_FALSE(fault.has_failed);
        EXPECT_TRUE(same_contacts(result.contacts, expected.contacts));
      } else {
        EXPECT_FALSE(succeeds([&] { engine->query(options, result); }));
        EXPECT_FALSE(succeeds([&] { engine->update(fibers); }));
      }
    }
  });
  // Another device serves.
  CudaTreeEngine engine(make_failing_device(), {});
  engine.update(fibers);
  EXPECT_TRUE(same_contacts(answer(engine, options).contacts, expected.contacts));
}

/// One that fails once goes on with what is asked for next, and has lost nothing.
void expect_recovery(bool is_for_good) {
  const FiberAssembly fibers = some_fibers();
  QueryOptions all = within(0.01);
  all.neighbour_skip = 1;
  const std::vector<Contact> near = brute_force(fibers, all).contacts;
  all.margin = 0.1;
  const std::vector<Contact> far = brute_force(fibers, all).contacts;
  ASSERT_GT(far.size(), 2 * near.size());
  for_each_failure(is_for_good, [&] {
    std::unique_ptr<DeviceProximity> device;
    const auto make = [&] {
      device = std::make_unique<DeviceProximity>(make_failing_device(), fibers.offsets(),
                                                 fibers.radii());
    };
    if (!succeeds(make)) {
      EXPECT_EQ(succeeds(make), !is_for_good);
    }
    if (device == nullptr) {
      return;
    }
    std::shared_ptr<void> lock;
    DeviceProximity::Contacts arrays;
    DeviceProximity::Contacts contacts;
    DeviceProximity::HostContacts copy;
    // Each once more where it fails. Contacts grow from one query to the next.
    const auto step = [&](const std::function<void()>& work) {
      return succeeds(work) || (succeeds(work) && !is_for_good);
    };
    const bool is_done = step([&] { lock = device->lock_points(fibers.points()); }) &&
                         step([&] { device->update_from_host(fibers.points()); }) && step([&] {
                           arrays = device->query_to_host({0.01});
                           expect_same(arrays, arrays.count, fibers, near);
                         }) &&
                         step([&] { device->update(fibers.points().front().data()); }) && step([&] {
                           arrays = device->query_to_host({0.1});
                           expect_same(arrays, arrays.count, fibers, far);
                         }) &&
                         step([&] { contacts = device->query({0.01}); }) && step([&] {
                           device->copy_to_host(contacts, copy);
                           expect_same(copy, copy.a.size(), fibers, near);
                         }) &&
                         step([&] { device->device_seconds(); });
    EXPECT_EQ(is_done, !(fault.has_failed && is_for_good));
    if (!is_done) {
      EXPECT_FALSE(succeeds([&] { device->update_from_host(fibers.points()); }));
      EXPECT_THROW(device->query({}), std::logic_error);
      EXPECT_THROW(device->query_to_host({}), std::logic_error);
    }
  });
}

TEST(LostDevice, EveryCallOfDeviceProximityTellsOfIt) { expect_recovery(true); }

TEST(LostDevice, OneThatFailsOnceGoesOn) { expect_recovery(false); }

/// Fibres that only the rule of loops decides about, whose points go to the host for it.
TEST(LostDevice, CandidatesTellOfIt) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::vector<FiberAssembly> coils;
  for (int i = 0; i < 20; ++i) {
    coils.push_back(coil(random));
  }
  const CandidateBatch batch(coils, FiberAssembly());
  const DeviceProximity::Options with_loops{0.0, std::nullopt};
  const auto make = [&] {
    return std::make_unique<DeviceProximity>(make_failing_device(), batch.offsets, batch.radii,
                                             batch.begins);
  };
  will_not_fail();
  std::vector<std::uint8_t> expected;
  std::vector<std::uint32_t> begins;
  {
    const std::unique_ptr<DeviceProximity> device = make();
    device->update_from_host(batch.points);
    device->check_candidates(with_loops, expected);
    const DeviceProximity::Contacts arrays = device->query_to_host({});
    begins.assign(arrays.candidate_begins, arrays.candidate_begins + coils.size() + 1);
  }
  const auto touching_count = std::count(expected.begin(), expected.end(), 1);
  ASSERT_TRUE(touching_count > 0 && touching_count < 20) << touching_count;
  for (const bool is_for_good : {false, true}) {
    for_each_failure(is_for_good, [&] {
      std::unique_ptr<DeviceProximity> device;
      std::vector<std::uint8_t> touching;
      DeviceProximity::Contacts arrays;
      const auto step = [&](const std::function<void()>& work) {
        return succeeds(work) || (succeeds(work) && !is_for_good);
      };
      const bool is_done = step([&] { device = make(); }) &&
                           step([&] { device->update_from_host(batch.points); }) &&
                           step([&] { device->check_candidates(with_loops, touching); }) &&
                           step([&] { arrays = device->query_to_host({}); });
      EXPECT_EQ(is_done, !(fault.has_failed && is_for_good));
      if (is_done) {
        EXPECT_EQ(touching, expected);
        EXPECT_TRUE(std::equal(begins.begin(), begins.end(), arrays.candidate_begins));
      }
    });
  }
}

}  // namespace
}  // namespace fiber::test

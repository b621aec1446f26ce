// What several have of one device at once: contacts that are held while others are found, engines
// on several threads.
#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <thread>
#include <vector>

#include "fiber_proximity/cuda/device_proximity.hpp"
#include "src/cuda/device_of.hpp"
#include "src/cuda/host_executor.hpp"
#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"
#include "test/support/cuda_tree.hpp"
#include "test/support/device_arrays.hpp"
#include "test/support/error_of.hpp"
#include "test/support/random.hpp"

namespace fiber::test {
namespace {

QueryOptions within_beyond_neighbours(double margin) {
  QueryOptions options = within(margin);
  options.neighbour_skip = 1;
  return options;
}

TEST(SharedDevice, ContactsStayAsLongAsTheyAreHeld) {
  Random random;
  const FiberAssembly fibers = walks(random, 12, 60, 0.05, 0.02);
  DeviceArrays arrays;
  DeviceProximity device(make_test_device(), fibers.offsets(), fibers.radii());
  device.update_from_host(fibers.points());
  std::vector<DeviceProximity::Contacts> held;
  std::vector<std::vector<Contact>> expected;
  for (const double margin : {0.0, 0.02, 0.2, 0.02, 0.0}) {  // ever more, and fewer again
    held.push_back(device.query({margin}));
    expected.push_back(answer("run_tree", fibers, within_beyond_neighbours(margin)).contacts);
  }
  ASSERT_GT(expected[2].size(), 2 * expected[0].size());
  device.query_to_host({0.1});
  device.update_from_host(shaken(fibers, 0.05, random).points());
  device.query({0.1});
  for (std::size_t i = 0; i < held.size(); ++i) {
    SCOPED_TRACE(i);
    expect_same(arrays, held[i], fibers, expected[i]);
  }
}

/// Counts how often others are waited for.
class WaitingExecutor : public HostExecutor<HeapMemory> {
 public:
  void wait_for_others() { ++waits; }
  int waits = 0;
};

/// Whoever has let go of contacts may have given the device work that reads them.
TEST(SharedDevice, WaitsForThoseWhoReadContactsBefore) {
  Random random;
  const FiberAssembly fibers = walks(random, 6, 40, 0.05, 0.02);
  const auto executor = std::make_shared<WaitingExecutor>();
  DeviceProximity device(std::make_unique<DeviceOf<WaitingExecutor>>(executor), fibers.offsets(),
                         fibers.radii());
  device.update_from_host(fibers.points());
  for (int i = 0; i < 3; ++i) {
    const int before = executor->waits;
    EXPECT_GT(device.query({0.1}).count, 0U);
    EXPECT_GT(executor->waits, before);
    const int between = executor->waits;
    EXPECT_GT(device.query_to_host({0.1}).count, 0U);
    EXPECT_GT(executor->waits, between);
  }
}

TEST(SharedDevice, MemoryOfContactsThatNobodyHoldsServesAgain) {
  Random random;
  const FiberAssembly fibers = walks(random, 6, 40, 0.05, 0.02);
  DeviceProximity device(make_test_device(), fibers.offsets(), fibers.radii());
  device.update_from_host(fibers.points());
  ASSERT_GT(device.query({0.1}).count, 0U);
  std::set<const std::uint32_t*> places;
  for (int i = 0; i < 20; ++i) {
    places.insert(device.query({0.1}).a);
  }
  EXPECT_EQ(places.size(), 1U);
  DeviceProximity::Contacts last;
  for (int i = 0; i < 20; ++i) {
    last = device.query({0.1});  // while those before are held
    places.insert(last.a);
  }
  EXPECT_EQ(places.size(), 2U);
}

/// Frames of an engine or a DeviceProximity, each on a thread of its own.
TEST(SharedDevice, ServesEnginesOnSeveralThreads) {
  register_cuda_tree();
  constexpr int user_count = 4;
  constexpr int frame_count = 12;
  constexpr double margin = 0.05;
  std::vector<std::vector<FiberAssembly>> frames(user_count);
  Random random;
  for (std::vector<FiberAssembly>& of_user : frames) {
    of_user.push_back(walks(random, 20, 50, 0.05, 0.01));
    while (of_user.size() < frame_count) {
      of_user.push_back(shaken(of_user.back(), 0.01, random));
    }
  }
  std::vector<std::vector<std::vector<Contact>>> found(user_count);
  std::vector<std::thread> threads;
  for (std::size_t user = 0; user < user_count; ++user) {
    threads.emplace_back([&, user] {
      const auto engine = make_engine("cuda_tree");
      for (const FiberAssembly& fibers : frames[user]) {
        engine->update(fibers);
        QueryResult result;
        engine->query(within_beyond_neighbours(margin), result);
        found[user].push_back(result.contacts);
      }
    });
  }
  std::size_t mismatches = 0;
  threads.emplace_back([&] {
    const FiberAssembly& first = frames[0].front();
    DeviceProximity device(make_test_device(), first.offsets(), first.radii());
    for (const FiberAssembly& fibers : frames[0]) {
      device.update_from_host(fibers.points());
      const std::size_t expected =
          answer("run_tree", fibers, within_beyond_neighbours(margin)).contacts.size();
      mismatches += device.query_to_host({margin}).count != expected ? 1 : 0;
    }
  });
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(mismatches, 0U);
  for (std::size_t user = 0; user < user_count; ++user) {
    ASSERT_EQ(found[user].size(), std::size_t{frame_count});
    for (std::size_t frame = 0; frame < frame_count; ++frame) {
      const std::vector<Contact> expected =
          answer("run_tree", frames[user][frame], within_beyond_neighbours(margin)).contacts;
      EXPECT_GT(expected.size(), 0U);
      EXPECT_TRUE(same_contacts(found[user][frame], expected)) << user << ", " << frame;
    }
  }
}

TEST(SharedDevice, RefusesPointersOfTheHost) {
  const std::vector<double> on_host(6, 0.0);
  DeviceProximity device(make_test_device(), {0, 2}, {0.1});
  if (!device.gpu()) {
    GTEST_SKIP() << "there is no GPU: all pointers are of the host";
  }
  EXPECT_EQ(error_of([&] { device.update(on_host.data()); }),
            "the points are not in the memory of a GPU");
  device.update_from_host({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}});
  EXPECT_EQ(device.query({}).count, 0U) << "it serves on";
}

}  // namespace
}  // namespace fiber::test

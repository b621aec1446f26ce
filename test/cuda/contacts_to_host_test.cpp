// Contacts that go to the host in parts while others are judged, and points that come from there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/cuda/device_proximity.hpp"
#include "src/cuda/device.hpp"
#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"
#include "test/support/cuda_tree.hpp"
#include "test/support/device_arrays.hpp"
#include "test/support/error_of.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

/// All families, with points anywhere and page-locked.
TEST(ContactsToHost, AreThoseOfRunTree) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::size_t count = 0;
  for (int round = 0; round < rounds(20); ++round) {
    for (const AssemblyFamily& family : assembly_families()) {
      const FiberAssembly fibers = family.make(random);
      if (fibers.point_count() == 0) {
        continue;
      }
      SCOPED_TRACE(family.name);
      DeviceProximity device(make_test_device(), fibers.offsets(), fibers.radii());
      const std::shared_ptr<void> lock =
          random.chance(0.5) ? device.lock_points(fibers.points()) : nullptr;
      device.update_from_host(fibers.points());
      const double margin = random.chance(0.5) ? 0.0 : 0.05 * extent_of(fibers);
      QueryOptions same = within(margin);
      same.neighbour_skip = 1;
      const std::vector<Contact> expected = answer("run_tree", fibers, same).contacts;
      const DeviceProximity::Contacts found = device.query_to_host({margin});
      expect_same(found, found.count, fibers, expected);
      if (HasFatalFailure()) {
        return;
      }
      count += expected.size();
    }
  }
  EXPECT_GT(count, 1000U);
}

/// What contacts were, to see that they stay as they are.
struct HeldContacts {
  DeviceProximity::Contacts contacts;
  std::vector<double> distances;

  explicit HeldContacts(const DeviceProximity::Contacts& found)
      : contacts(found), distances(found.distance, found.distance + found.count) {}
  bool are_as_they_were() const {
    return std::equal(distances.begin(), distances.end(), contacts.distance);
  }
};

/// More contacts than there is room for on the device, on the host, or for the first parts only;
/// then fewer, none, and more again.
TEST(ContactsToHost, GrowAndShrinkFromFrameToFrame) {
  SCOPED_TRACE(seed_message());
  Random random;
  constexpr int fiber_count = rounds_less > 1 ? 3 : 12;
  FiberAssembly fibers = walks(random, fiber_count, 100, 0.05, 0.01);
  DeviceProximity device(make_test_device(), fibers.offsets(), fibers.radii());
  const std::vector<Eigen::Vector3d>& points = fibers.points();
  const std::shared_ptr<void> lock = device.lock_points(points);
  std::size_t most = 0;
  std::vector<HeldContacts> held;
  for (const double margin : {0.0, 0.02, 0.3, 0.0, 0.2, 3.0, 3.0, 0.3, 0.05}) {
    SCOPED_TRACE(margin);
    // Where they were locked.
    fibers.update_points(shaken(fibers, 0.01, random).points());
    if (random.chance(0.5)) {
      device.update_from_host(points);
    } else {
      device.update_from_host(points.front().data());
    }
    QueryOptions same = within(margin);
    same.neighbour_skip = 1;
    const std::vector<Contact> expected = answer("run_tree", fibers, same).contacts;
    const bool on_device_first = random.chance(0.5);
    if (on_device_first) {
      EXPECT_EQ(device.query({margin}).count, expected.size());
    }
    const DeviceProximity::Contacts found = device.query_to_host({margin});
    expect_same(found, found.count, fibers, expected);
    if (HasFatalFailure()) {
      return;
    }
    if (held.size() < 2 || random.chance(0.5)) {
      held.emplace_back(found);
    }
    most = std::max(most, expected.size());
  }
  EXPECT_GT(most, fiber_count * fiber_count * 3000U);
  // No pair is near.
  std::vector<Eigen::Vector3d> apart = points;
  for (std::size_t i = 0; i < apart.size(); ++i) {
    apart[i].x() += 100.0 * static_cast<double>(i);
  }
  device.update_from_host(apart);
  EXPECT_EQ(device.query_to_host({0.0}).count, 0U);
  for (const HeldContacts& before : held) {
    EXPECT_TRUE(before.are_as_they_were());
  }
  EXPECT_EQ(
      error_of([&] { device.update_from_host(nullptr); }),
      "the points are a null pointer, the fibres have " + std::to_string(fibers.point_count()));
  EXPECT_EQ(error_of([&] {
              device.lock_points({{0.0, 0.0, 0.0}});
            }),
            "there are 1 points, the fibres have " + std::to_string(fibers.point_count()));
}

/// One after the other, and by another device in between: what is locked belongs to none.
TEST(ContactsToHost, LockedPointsServeEveryDevice) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = walks(random, 5, 100, 0.05, 0.02);
  DeviceProximity one(make_test_device(), fibers.offsets(), fibers.radii());
  DeviceProximity other(make_test_device(), fibers.offsets(), fibers.radii());
  std::shared_ptr<void> lock = one.lock_points(fibers.points());
  one.update_from_host(fibers.points());
  other.update_from_host(fibers.points());
  const std::uint32_t count = one.query_to_host({0.01}).count;
  EXPECT_GT(count, 100U);
  EXPECT_EQ(other.query_to_host({0.01}).count, count);
  if (std::getenv("FIBER_PROXIMITY_TEST_GPU") != nullptr) {
    EXPECT_EQ(error_of([&] { one.lock_points(fibers.points()); }),
              "this memory of the host is page-locked already");
  }
  lock.reset();
  lock = other.lock_points(fibers.points());
  lock.reset();
  one.update_from_host(fibers.points());
  EXPECT_EQ(one.query_to_host({0.01}).count, count);
}

}  // namespace
}  // namespace fiber::test

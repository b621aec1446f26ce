// The engine of GPUs beside the others: here with its kernels as loops, and on a GPU where
// scripts/check_gpu.sh runs it. What holds for every engine is asked of it in the tests of these.
#include "test/support/cuda_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "fiber_proximity/cuda/device_proximity.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/cuda/device.hpp"
#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"
#include "test/support/device_arrays.hpp"
#include "test/support/error_of.hpp"
#include "test/support/query_options.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

class CudaTreeTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { register_cuda_tree(); }
};

/// The fields of contacts, which leave no gap, byte by byte.
bool same_bytes(const std::vector<Contact>& x, const std::vector<Contact>& y) {
  static_assert(sizeof(Contact) == 4 * sizeof(std::uint32_t) + 14 * sizeof(double));
  return x.size() == y.size() && (x.empty() || std::memcmp(static_cast<const void*>(x.data()),
                                                           static_cast<const void*>(y.data()),
                                                           x.size() * sizeof(Contact)) == 0);
}

int scene_count() {
  const char* const wanted = std::getenv("FIBER_PROXIMITY_TEST_SCENES");
  return wanted != nullptr ? std::atoi(wanted) : rounds(300);
}

TEST_F(CudaTreeTest, GivesTheBytesOfTheOthers) {
  SCOPED_TRACE(seed_message());
  Random random;
  const std::vector<AssemblyFamily> families = assembly_families();
  const std::unique_ptr<ProximityEngine> engine = make_engine("cuda_tree");
  const std::unique_ptr<ProximityEngine> other = make_engine("run_tree");
  std::size_t contacts = 0;
  for (int scene = 0; scene < scene_count(); ++scene) {
    const AssemblyFamily& family = families[static_cast<std::size_t>(
        random.integer(0, static_cast<int>(families.size()) - 1))];
    SCOPED_TRACE(family.name + ", scene " + std::to_string(scene));
    const FiberAssembly fibers = family.make(random);
    QueryOptions options = random_options(random, extent_of(fibers));
    // Which one FIRST reports depends on the engine.
    options.type = options.type == QueryType::FIRST ? QueryType::ALL : options.type;
    engine->update(fibers);
    other->update(fibers);
    const QueryResult found = answer(*engine, options);
    ASSERT_TRUE(same_bytes(found.contacts, answer(*other, options).contacts));
    ASSERT_TRUE(same_contacts(found.contacts, brute_force(fibers, options).contacts));
    ASSERT_TRUE(found.complete || options.contact_limit != 0);
    contacts += found.contacts.size();
  }
  EXPECT_GT(contacts, 10U * static_cast<std::size_t>(scene_count()));
}

/// Leaves and nodes that are full, but for one, or begin with one.
TEST_F(CudaTreeTest, TakesAnyNumberOfSegments) {
  SCOPED_TRACE(seed_message());
  Random random;
  const std::unique_ptr<ProximityEngine> engine = make_engine("cuda_tree");
  for (const int segments : {1, 2, 31, 32, 33, 63, 64, 65, 1023, 1024, 1025, 1056, 1057}) {
    SCOPED_TRACE(segments);
    const FiberAssembly fibers = walks(random, 1, segments, 0.1, 0.02);
    engine->update(fibers);
    const QueryOptions options = within(0.01);
    EXPECT_TRUE(
        same_contacts(answer(*engine, options).contacts, brute_force(fibers, options).contacts));
  }
}

/// Many more pairs than there is room for at first, then few, then more again.
TEST_F(CudaTreeTest, GrowsItsRoomAndCutsNothingOff) {
  SCOPED_TRACE(seed_message());
  Random random;
  const std::unique_ptr<ProximityEngine> engine = make_engine("cuda_tree");
  const std::unique_ptr<ProximityEngine> other = make_engine("run_tree");
  constexpr int fiber_count = rounds_less > 1 ? 3 : 20;
  const FiberAssembly fibers = walks(random, fiber_count, 100, 0.05, 0.05);
  engine->update(fibers);
  other->update(fibers);
  std::size_t most = 0;
  for (const double margin : {0.0, 0.5, 0.01, 10.0, 0.0, 1.0}) {
    SCOPED_TRACE(margin);
    const QueryResult found = answer(*engine, within(margin));
    EXPECT_TRUE(same_bytes(found.contacts, answer(*other, within(margin)).contacts));
    most = std::max(most, found.contacts.size());
  }
  EXPECT_GT(most, fiber_count * fiber_count * 3000U);
}

TEST_F(CudaTreeTest, AnswersTheSameWhenAskedAgain) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = walks(random, 30, 100, 0.05, 0.02);
  const std::unique_ptr<ProximityEngine> engine = make_engine("cuda_tree");
  engine->update(fibers);
  const QueryResult first = answer(*engine);
  expect_enough(first.contacts.size(), std::size_t{50});
  for (int round = 0; round < 5; ++round) {
    engine->update(fibers);
    EXPECT_TRUE(same_bytes(answer(*engine).contacts, first.contacts));
    EXPECT_TRUE(same_bytes(answer("cuda_tree", fibers).contacts, first.contacts));
  }
}

TEST_F(CudaTreeTest, UsesMemoryThatItTellsOf) {
  SCOPED_TRACE(seed_message());
  Random random;
  const std::unique_ptr<ProximityEngine> engine = make_engine("cuda_tree");
  const FiberAssembly fibers = walks(random, 10, 1000, 0.1, 0.01);
  engine->update(fibers);
  constexpr double most_bytes = 120.0;  // a segment, but for pairs
  const double bytes = static_cast<double>(engine->facts().memory_bytes);
  EXPECT_LE(bytes, most_bytes * static_cast<double>(fibers.segment_count()));
  EXPECT_GE(bytes, 60.0 * static_cast<double>(fibers.segment_count()));
}

/// Of the same bits as on the host, for points of either precision.
TEST(DeviceProximity, GivesRunTreesContacts) {
  SCOPED_TRACE(seed_message());
  Random random;
  DeviceArrays arrays;
  std::size_t count = 0;
  for (int round = 0; round < scene_count() / 10 + 1; ++round) {
    for (const AssemblyFamily& family : assembly_families()) {
      const FiberAssembly drawn = family.make(random);
      if (drawn.point_count() == 0) {
        continue;
      }
      SCOPED_TRACE(family.name);
      const bool is_single = random.chance(0.3) && extent_of(drawn) < 1e6;
      FiberAssembly fibers = drawn;
      const std::vector<float> rounded = coordinates_of<float>(drawn);
      if (is_single) {
        std::vector<Eigen::Vector3d> points;
        for (std::size_t i = 0; i < rounded.size(); i += 3) {
          points.push_back(Eigen::Map<const Eigen::Vector3f>(&rounded[i]).cast<double>());
        }
        fibers.update_points(points);
      }
      DeviceProximity device(make_test_device(), fibers.offsets(), fibers.radii());
      if (is_single) {
        device.update(arrays.put(rounded).get());
      } else {
        device.update(arrays.put(coordinates_of<double>(fibers)).get());
      }
      const DeviceProximity::Options options = random_device_options(random, fibers);
      const QueryResult expected = answer("run_tree", fibers, same_query(options));
      expect_same(arrays, device.query(options), fibers, expected.contacts);
      if (HasFatalFailure()) {
        return;
      }
      count += expected.contacts.size();
    }
  }
  EXPECT_GT(count, 1000U);
}

/// Of the last update and the last query alone, whichever these were.
TEST(DeviceProximity, TellsWhatEachStageTook) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = walks(random, 10, 200, 0.05, 0.01);
  DeviceProximity device(make_test_device(), fibers.offsets(), fibers.radii());
  const auto names = [&] {
    std::string all;
    double sum = 0.0;
    for (const DeviceProximity::Stage& stage : device.device_stages()) {
      EXPECT_GT(stage.seconds, 0.0) << stage.name;
      all += (all.empty() ? "" : ", ") + stage.name;
      sum += stage.seconds;
    }
    EXPECT_DOUBLE_EQ(sum, device.device_seconds());
    return all;
  };
  EXPECT_EQ(names(), "");
  DeviceArrays arrays;
  device.update(arrays.put(coordinates_of<float>(fibers)).get());
  EXPECT_EQ(names(), "points, bounds, order, tree");
  for (int round = 0; round < 2; ++round) {
    device.update_from_host(fibers.points());
    device.query({0.01});
    EXPECT_EQ(names(), "bounds, order, tree, pairs, order of pairs, contacts");
    device.query_to_host({0.1});
    EXPECT_EQ(names(), "bounds, order, tree, pairs, order of pairs, contacts");
  }
}

TEST(DeviceProximity, RefusesWhatIsNotAllowed) {
  DeviceArrays arrays;
  EXPECT_NE(error_of([] { DeviceProximity(make_test_device(), {0, 1}, {0.1}); }), "no error");
  EXPECT_NE(error_of([] { DeviceProximity(make_test_device(), {0, 2}, {-0.1}); }), "no error");
  DeviceProximity device(make_test_device(), {0, 2, 4}, {0.1});
  EXPECT_THROW(device.query({}), std::logic_error);
  std::vector<double> coordinates(12, 0.0);
  coordinates[1] = 1.0;
  coordinates[7] = 2.0;
  device.update(arrays.put(coordinates).get());
  EXPECT_EQ(device.query({}).count, 1U);
  EXPECT_EQ(error_of([&] {
              device.update_from_host({{0.0, 0.0, 0.0}});
            }),
            "there are 1 points, the fibres have 4");
  EXPECT_EQ(error_of([&] {
              device.update_from_host({{0, 0, 0}, {0, 0, 0}, {0, 1e151, 0}, {0, 0, 0}});
            }),
            "point 2: y is 1e+151, coordinates must be finite and at most 1e150 m in magnitude");
  EXPECT_THROW(device.query_to_host({}), std::logic_error);
  device.update_from_host(std::vector<Eigen::Vector3d>(4, Eigen::Vector3d::Zero()));
  DeviceProximity::HostContacts contacts;
  device.copy_to_host(device.query({}), contacts);
  EXPECT_EQ(contacts.a, std::vector<std::uint32_t>{0});
  EXPECT_EQ(contacts.b, std::vector<std::uint32_t>{2});
  EXPECT_EQ(contacts.distance, std::vector<double>{-0.2});
  EXPECT_EQ(error_of([&] { device.query({-1.0}); }),
            "margin is -1.000000 m, it must be finite and not negative");
  coordinates[4] = std::numeric_limits<double>::quiet_NaN();
  coordinates[5] = 1e200;
  const std::string bad =
      "point 1: y is nan, coordinates must be finite and at most 1e150 m in magnitude";
  EXPECT_EQ(error_of([&] { device.update(arrays.put(coordinates).get()); }), bad);
  EXPECT_THROW(device.query({}), std::logic_error);
}

TEST(CudaDevice, SaysWhatItLooksForWhereThereIsNone) {
  std::string error;
  try {
    make_cuda_device();
    GTEST_SKIP() << "there is a GPU";
  } catch (const std::runtime_error& refusal) {
    error = refusal.what();
  }
#ifdef FIBER_PROXIMITY_HAS_DEVICE_MODULE
  const std::string expected = "cuda_tree needs an NVIDIA GPU of compute capability 7.5";
#else
  const std::string expected = "cuda_tree: it needs libfiber_proximity_cuda_device.so.";
#endif
  EXPECT_EQ(error.rfind(expected, 0), 0U) << error;
}

}  // namespace
}  // namespace fiber::test

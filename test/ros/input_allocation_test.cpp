// How often the points of a PointCloud2 are copied on their way to the engine, told by the memory
// they take: from the message into the input's assembly, and from there into the merged one where
// there are several inputs.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <limits>
#include <new>

#include "src/ros/inputs/merged_fibers.hpp"
#include "src/ros/inputs/message_reader.hpp"
#include "src/ros/inputs/point_messages.hpp"
#include "test/ros/messages.hpp"

namespace {

constexpr std::size_t point_count = 1000;

std::atomic<std::size_t> allocations{0};
std::atomic<std::size_t> point_arrays{0};  // allocations that have room for all points

void count_allocation(std::size_t size) {
  ++allocations;
  point_arrays += size >= point_count * sizeof(Eigen::Vector3d) ? 1 : 0;
}

}  // namespace

// Counts every allocation of this process. GCC inlines one half of the pair and then believes that
// new and free are mixed.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
void* operator new(std::size_t size) {
  count_allocation(size);
  if (void* memory = std::malloc(size)) {
    return memory;
  }
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }

namespace fiber_proximity_ros {
namespace {

/// One input, from a message to fibres in the fixed frame.
class Walk {
 public:
  Walk() {
    options_.name = "cable";
    options_.radius = 0.01;
    options_.missing_points = MissingPoints::BRIDGE;
  }

  FiberMessagePtr receive(const sensor_msgs::PointCloud2& cloud) {
    FiberMessagePtr message = reader_.read(
        [&cloud](FiberBuffer& fibers) {
          to_chains(cloud, fibers);
          return ReadResult();
        },
        stamps_);
    message->fibers.transform(pose_);
    return message;
  }

 private:
  InputOptions options_;
  InputStamps stamps_{InputTiming()};
  MessageReader reader_{options_};
  Eigen::Isometry3d pose_{Eigen::Translation3d(1.0, 2.0, 3.0)};
};

class InputAllocationTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { ros::Time::init(); }

  static sensor_msgs::PointCloud2 cloud(bool has_gap) {
    test_messages::Points points;
    for (std::size_t i = 0; i < point_count; ++i) {
      points.emplace_back(0.01 * static_cast<double>(i), 0.0, 0.0);
    }
    if (has_gap) {
      points[7].y() = std::numeric_limits<double>::quiet_NaN();
    }
    return test_messages::point_cloud2(test_messages::header("camera"), points);
  }

  /// Messages of so many inputs, merged.
  std::shared_ptr<const FiberMessage> merge(std::size_t inputs,
                                            const sensor_msgs::PointCloud2& message) {
    std::vector<FiberMessagePtr> messages;
    messages.reserve(inputs);
    for (std::size_t i = 0; i < inputs; ++i) {
      messages.push_back(walks_[i].receive(message));
    }
    merged_.merge(messages);
    return merged_.message();
  }

  Walk walks_[2];
  MergedFibers merged_;
};

TEST_F(InputAllocationTest, TheFirstMessageOfAnInputIsCopiedOnce) {
  const sensor_msgs::PointCloud2 message = cloud(false);
  const std::size_t before = point_arrays;
  const auto merged = merge(1, message);
  EXPECT_EQ(point_arrays - before, 1U);
  EXPECT_EQ(merged->fibers.point_count(), point_count);
  EXPECT_EQ(merged->fibers.points()[0], Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST_F(InputAllocationTest, MissingPointsAreBridgedInPlace) {
  const sensor_msgs::PointCloud2 message = cloud(true);
  const std::size_t before = point_arrays;
  const auto merged = merge(1, message);
  EXPECT_EQ(point_arrays - before, 1U);
  EXPECT_EQ(merged->fibers.point_count(), point_count - 1);
}

TEST_F(InputAllocationTest, TheFirstMessagesOfTwoInputsAreCopiedTwice) {
  const sensor_msgs::PointCloud2 message = cloud(false);
  const std::size_t before = point_arrays;
  EXPECT_EQ(merge(2, message)->fibers.point_count(), 2 * point_count);
  EXPECT_EQ(point_arrays - before, 3U);  // one for each input, one for both
}

TEST_F(InputAllocationTest, AMessageInSteadyStateTakesNoMemoryButTheListOfInputs) {
  const sensor_msgs::PointCloud2 message = cloud(false);
  for (const std::size_t inputs : {std::size_t{1}, std::size_t{2}}) {
    constexpr int warm_up = 5;
    std::size_t before = 0;
    for (int i = 0; i < 2 * warm_up; ++i) {
      before = i == warm_up ? allocations.load() : before;
      merge(inputs, message);
    }
    EXPECT_EQ(allocations - before, std::size_t{warm_up}) << inputs << " input(s)";
  }
}

}  // namespace
}  // namespace fiber_proximity_ros

#include "src/ros/detection/detector.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "fiber_proximity/paper/paper_engines.hpp"
#include "test/support/answers.hpp"
#include "test/support/random.hpp"

namespace fiber_proximity_ros {
namespace {

const fiber::FiberAssembly unequal({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}},
                                   {0, 2, 5}, {0.1});
const fiber::FiberAssembly equal({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {0, 2, 4}, {0.1});

TEST(Detector, RefusesFibersTheEngineCannotTakeAsOftenAsItIsAsked) {
  fiber::register_paper_engines();
  Detector detector("AL-threaded");
  detector.set_fibers(unequal);
  EXPECT_THROW(detector.detect(fiber::QueryOptions()), std::invalid_argument);
  EXPECT_THROW(detector.engine(), std::invalid_argument);
  detector.set_fibers(equal);
  detector.detect(fiber::QueryOptions());
  ASSERT_NE(detector.detection().minimum(), nullptr);
  EXPECT_DOUBLE_EQ(detector.detection().minimum()->distance, 0.8);
}

TEST(Detector, FindsTheMinimumBeyondTheMarginAndWhateverTheType) {
  Detector detector("run_tree");
  detector.set_fibers(equal);
  fiber::QueryOptions options;
  for (const auto type : {fiber::QueryType::ALL, fiber::QueryType::FIRST}) {
    options.type = type;
    detector.detect(options);
    EXPECT_TRUE(detector.detection().contacts().contacts.empty());
    ASSERT_NE(detector.detection().minimum(), nullptr);
    EXPECT_DOUBLE_EQ(detector.detection().minimum()->distance, 0.8);
  }
}

TEST(Detector, FindsTheMinimumAmongContactsThatAreNotTheClosest) {
  SCOPED_TRACE(fiber::test::seed_message());
  fiber::test::Random random;
  std::vector<Eigen::Vector3d> points(60);
  for (int round = 0; round < 20; ++round) {
    for (Eigen::Vector3d& point : points) {
      point = random.in_cube();
    }
    const fiber::FiberAssembly fibers(points, {0, 20, 60}, {0.01});
    fiber::QueryOptions options;
    options.type = fiber::QueryType::CLOSEST;
    options.margin = std::numeric_limits<double>::infinity();
    const fiber::QueryResult closest = fiber::test::brute_force(fibers, options);
    Detector detector("run_tree");
    detector.set_fibers(fibers);
    options.max_contacts = 3;
    for (const auto type :
         {fiber::QueryType::FIRST, fiber::QueryType::CLOSEST, fiber::QueryType::LIMITED,
          fiber::QueryType::ALL, fiber::QueryType::FIBER_PAIRS}) {
      for (const double margin : {0.0, 0.05, 10.0}) {
        options.type = type;
        options.margin = margin;
        detector.detect(options);
        ASSERT_NE(detector.detection().minimum(), nullptr);
        EXPECT_EQ(detector.detection().minimum()->key(), closest.contacts.front().key());
        EXPECT_EQ(detector.detection().minimum()->distance, closest.contacts.front().distance);
      }
    }
  }
}

TEST(Detector, HasNoMinimumWithoutAPair) {
  const fiber::FiberAssembly none;
  Detector detector("run_tree");
  detector.set_fibers(none);
  detector.detect(fiber::QueryOptions());
  EXPECT_EQ(detector.detection().minimum(), nullptr);
}

}  // namespace
}  // namespace fiber_proximity_ros

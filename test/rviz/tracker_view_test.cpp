// The view of launch/with_tracker.launch: from cables somewhere before a camera to pixels.
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <visualization_msgs/MarkerArray.h>

#include <cmath>
#include <string>

#include "fiber_proximity/FiberArray.h"
#include "test/ros/messages.hpp"
#include "validation/rviz/rviz_window.hpp"

namespace {

using fiber_proximity::FiberArray;
using rviz_test::Pixel;
using rviz_test::RvizWindow;

constexpr const char* optical_frame = "camera_color_optical_frame";

/// The first fibre's colour, lit from wherever; the z axis is of another blue, without green.
bool is_blue(const Pixel& pixel) {
  return pixel[2] > 50 && pixel[2] > 3 * pixel[0] && 3 * pixel[1] > pixel[2];
}

/// Cables of 0.5 m that hang side by side, 5 cm apart, each a little bent.
/// @param middle [m] of the first
FiberArray cables(const Eigen::Vector3d& middle, std::uint32_t count = 1) {
  test_messages::Points points;
  std::vector<std::uint32_t> offsets{0};
  for (std::uint32_t cable = 0; cable < count; ++cable) {
    for (int i = -22; i <= 22; ++i) {
      const double s = i / 22.0;
      points.emplace_back(middle + Eigen::Vector3d(0.25 * s, 0.05 * s * s + 0.05 * cable, 0.0));
    }
    offsets.push_back(static_cast<std::uint32_t>(points.size()));
  }
  FiberArray message =
      test_messages::fiber_array(test_messages::header(optical_frame, ros::Time::now()), points);
  message.offsets = offsets;
  message.radii = {0.005};
  return message;
}

/// rviz as with_tracker.launch starts it.
class TrackerViewTest : public testing::Test {
 protected:
  // rviz's window can be made once in a process; load() begins anew.
  static void SetUpTestSuite() { window = new RvizWindow(640, 400); }
  static void TearDownTestSuite() {
    delete window;
    window = nullptr;
  }

  void SetUp() override {
    ASSERT_TRUE(window->load(TRACKER_VIEW, optical_frame));
    wait_for_subscriber();
  }

  void wait_for_subscriber() {
    ASSERT_TRUE(RvizWindow::wait_until([this] { return publisher_.getNumSubscribers() == 1; }));
  }

  /// Publishes until so many pixels of the picture's middle, two thirds of it, are the first
  /// cable's.
  void expect_cable(const FiberArray& message) {
    EXPECT_TRUE(RvizWindow::wait_until([&] {
      publisher_.publish(message);
      window->settle();
      return window->count_pixels(is_blue, 1.0 / 6.0) > 500;
    }));
    // All of it is in the picture, and nearly all of that is the middle.
    EXPECT_GT(window->count_pixels(is_blue, 1.0 / 6.0), window->count_pixels(is_blue) * 9 / 10);
  }

  void show(const FiberArray& message) {
    publisher_.publish(message);
    for (int i = 0; i < 3; ++i) {
      window->settle();
    }
  }

  double number(const char* name) { return window->view().subProp(name)->getValue().toDouble(); }

  static RvizWindow* window;
  ros::NodeHandle node_;
  ros::Publisher publisher_{node_.advertise<FiberArray>("/proximity/fibers", 1)};
};

RvizWindow* TrackerViewTest::window = nullptr;

TEST_F(TrackerViewTest, FindsACableBeforeTheCamera) {
  window->settle();
  EXPECT_LT(window->count_pixels(is_blue, 1.0 / 6.0), 50U) << "but for the smoothed z axis";
  expect_cable(cables({0.0, 0.0, 0.6}));
}

bool is_amber(const Pixel& pixel) {
  return pixel[0] > 150 && pixel[1] > 90 && pixel[1] < pixel[0] && pixel[2] < 90;
}
bool is_red(const Pixel& pixel) { return pixel[0] > 150 && pixel[1] < 80 && pixel[2] < 80; }

TEST_F(TrackerViewTest, SaysInTheWindowThatItWaitsUntilThereAreFibers) {
  window->settle();
  rviz::Display* fibers = window->find("Fibers");
  ASSERT_NE(fibers, nullptr);
  const rviz_test::Status waiting = RvizWindow::status(*fibers, "Fibers");
  EXPECT_EQ(waiting.level, rviz::StatusProperty::Warn);
  EXPECT_EQ(waiting.text, "waiting for the first message of /proximity/fibers");
  EXPECT_GT(window->count_pixels(is_amber), 100U) << "letters";
  expect_cable(cables({0.0, 0.0, 0.6}));
  window->settle();
  EXPECT_EQ(RvizWindow::status(*fibers, "Fibers").level, rviz::StatusProperty::Ok);
  EXPECT_EQ(window->count_pixels(is_amber), 0U);
}

TEST_F(TrackerViewTest, TheLegendIsInTheCornerWhereverItsMarkersAre) {
  ros::Publisher markers =
      node_.advertise<visualization_msgs::MarkerArray>("/proximity/markers", 1);
  ASSERT_TRUE(RvizWindow::wait_until([&] { return markers.getNumSubscribers() > 0; }));
  expect_cable(cables({0.0, 0.0, 0.6}));
  EXPECT_EQ(window->count_pixels(is_red), 0U);
  visualization_msgs::MarkerArray legend;
  legend.markers.resize(1);
  visualization_msgs::Marker& marker = legend.markers[0];
  marker.header = test_messages::header(optical_frame, ros::Time::now());
  marker.ns = "legend";
  marker.type = visualization_msgs::Marker::TEXT_VIEW_FACING;
  marker.pose.position.z = 0.6;  // across the cable
  marker.pose.orientation.w = 1.0;
  marker.scale.z = 0.05;
  marker.color.r = marker.color.a = 1.0F;
  marker.text = "red: penetrating\n\n";
  ASSERT_TRUE(RvizWindow::wait_until([&] {
    markers.publish(legend);
    window->settle();
    return window->count_pixels(is_red) > 100;
  }));
  EXPECT_EQ(window->count_pixels(is_red, 1.0 / 6.0), 0U)
      << "none in the middle, where the cable is";
  marker.action = visualization_msgs::Marker::DELETE;
  markers.publish(legend);
  EXPECT_TRUE(RvizWindow::wait_until([&] {
    window->settle();
    return window->count_pixels(is_red) == 0;
  }));
}

TEST_F(TrackerViewTest, FindsACableFarAwayInAnotherFrame) {
  window->set_fixed_frame("base_link");
  FiberArray message = cables({3.0, -2.0, 1.5});
  message.header.frame_id = "base_link";
  const double pitch = number("Pitch");
  expect_cable(message);
  EXPECT_EQ(number("Pitch"), pitch) << "z is upwards there";
}

TEST_F(TrackerViewTest, FollowsNewCablesUntilTheUserMovesIt) {
  expect_cable(cables({0.0, 0.0, 0.6}));
  const double distance = number("Distance");
  // The same cable elsewhere is no reason to move.
  show(cables({0.3, 0.0, 0.6}));
  EXPECT_EQ(number("Distance"), distance);
  EXPECT_NEAR(window->view().subProp("Focal Point")->subProp("X")->getValue().toDouble(), 0.0,
              1e-6);
  // More cables are: these reach over 2 m.
  show(cables({0.0, 0.0, 0.6}, 40));
  EXPECT_GT(number("Distance"), 1.5 * distance);
  window->view().subProp("Yaw")->setValue(1.0);
  show(cables({0.0, 0.0, 0.6}, 80));
  EXPECT_EQ(number("Yaw"), 1.0);
}

TEST_F(TrackerViewTest, AnotherFrameIsLookedAtAnew) {
  expect_cable(cables({0.0, 0.0, 0.6}));
  window->view().subProp("Distance")->setValue(100.0);
  window->set_fixed_frame("base_link");
  FiberArray message = cables({3.0, -2.0, 1.5});
  message.header.frame_id = "base_link";
  expect_cable(message);
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "tracker_view_test");
  testing::InitGoogleTest(&argc, argv);
  const QApplication application(argc, argv);
  return RUN_ALL_TESTS();
}

// The display inside rviz, from message to pixels.
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <QApplication>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "fiber_proximity/ContactArray.h"
#include "fiber_proximity/FiberArray.h"
#include "test/ros/messages.hpp"
#include "test/support/not_finite.hpp"
#include "validation/rviz/rviz_window.hpp"

namespace {

using fiber::test::nan;
using fiber_proximity::Contact;
using fiber_proximity::ContactArray;
using fiber_proximity::FiberArray;
using rviz_test::Pixel;
using rviz_test::RvizWindow;
using rviz_test::Status;

constexpr int ok = rviz::StatusProperty::Ok;
constexpr int warning = rviz::StatusProperty::Warn;
constexpr int error = rviz::StatusProperty::Error;

bool is_red(const Pixel& pixel) { return pixel[0] > 2 * pixel[1] && pixel[0] > 2 * pixel[2]; }
bool is_green(const Pixel& pixel) { return pixel[1] > 2 * pixel[0] && pixel[1] > 2 * pixel[2]; }

/// A cross of two fibres, 1 m long.
FiberArray cross(double stamp = 1.0) {
  FiberArray message = test_messages::fiber_array(
      test_messages::header("world", ros::Time(stamp)),
      {{-0.5, 0, 0}, {0, 0, 0.1}, {0.5, 0, 0}, {0, -0.5, 0}, {0, 0.5, 0}});
  message.offsets = {0, 3, 5};
  message.radii = {0.03};
  return message;
}

class DisplayTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { window_ = new RvizWindow; }
  static void TearDownTestSuite() {
    delete window_;
    window_ = nullptr;
  }

  DisplayTest()
      : publisher_(node_.advertise<FiberArray>("fibers", 1)),
        contact_publisher_(node_.advertise<ContactArray>("contacts", 1)),
        display_(window_->add("fiber_proximity/FiberArray")) {}
  ~DisplayTest() override { window_->remove(display_); }

  void set(const char* property, const QVariant& value) {
    ASSERT_NE(display_.subProp(property), nullptr);
    display_.subProp(property)->setValue(value);
  }

  void SetUp() override {
    set("Topic", "fibers");
    ASSERT_TRUE(RvizWindow::wait_until([this] { return publisher_.getNumSubscribers() == 1; }));
  }

  Status status(const char* name = "Fibers") const { return RvizWindow::status(display_, name); }

  /// Publishes and waits for the display's judgement, which must hold the text.
  void expect_status(const FiberArray& message, int level, const std::string& text) {
    // Statuses of before are on their way: the next one may have the same text.
    window_->settle();
    const std::string before = status("Topic").text;
    publisher_.publish(message);
    ASSERT_TRUE(RvizWindow::wait_until([&] { return status("Topic").text != before; }));
    window_->settle();
    EXPECT_EQ(status().level, level) << status().text;
    EXPECT_NE(status().text.find(text), std::string::npos) << status().text;
  }

  void expect_contact_status(int level) {
    EXPECT_TRUE(RvizWindow::wait_until([&] { return status("Contacts").level == level; }))
        << status("Contacts").text;
    window_->settle();
  }

  static RvizWindow* window_;
  ros::NodeHandle node_;
  ros::Publisher publisher_;
  ros::Publisher contact_publisher_;
  rviz::Display& display_;
};

RvizWindow* DisplayTest::window_ = nullptr;

TEST_F(DisplayTest, DrawsTubesAndRibbons) {
  EXPECT_EQ(window_->count_drawn(), 0U);
  expect_status(cross(), ok, "2 fiber(s), 3 segment(s) as tubes");
  const std::size_t tubes = window_->count_drawn();
  EXPECT_GT(tubes, 1000U);
  set("Style", "Ribbons");
  ASSERT_TRUE(RvizWindow::wait_until(
      [this] { return status().text.find("as ribbons") != std::string::npos; }));
  window_->settle();
  // As wide as the tubes, but flat at the ends.
  const std::size_t ribbons = window_->count_drawn();
  EXPECT_GT(ribbons, tubes * 9 / 10);
  EXPECT_LT(ribbons, tubes * 11 / 10);
}

TEST_F(DisplayTest, FollowsTheMessages) {
  expect_status(cross(1.0), ok, "2 fiber(s)");
  const std::size_t wide = window_->count_drawn();
  FiberArray thin = cross(2.0);
  thin.radii = {0.01};
  expect_status(thin, ok, "2 fiber(s)");
  EXPECT_LT(window_->count_drawn(), wide * 2 / 3);
  FiberArray none = cross(3.0);
  none.points.clear();
  none.offsets = {0};
  expect_status(none, ok, "0 fiber(s)");
  EXPECT_EQ(window_->count_drawn(), 0U);
}

TEST_F(DisplayTest, FlatColorAndAlphaAreThoseChosen) {
  set("Color By", "Flat Color");
  set("Color", QColor(255, 0, 0));
  expect_status(cross(), ok, "");
  const std::size_t drawn = window_->count_drawn();
  EXPECT_GT(window_->count_pixels(is_red), drawn * 3 / 4);
  for (const char* style : {"Ribbons", "Tubes"}) {
    set("Style", style);
    set("Color", QColor(0, 255, 0));
    expect_status(cross(), ok, "");
    EXPECT_GT(window_->count_pixels(is_green), window_->count_drawn() / 2) << style;
  }
  set("Alpha", 0.0);
  expect_status(cross(), ok, "");
  EXPECT_LT(window_->count_pixels(is_green), drawn / 10);
}

TEST_F(DisplayTest, RadiusColorsSpanTheRange) {
  set("Color By", "Radius");
  FiberArray message = cross();
  message.radii = {0.02, 0.03};
  expect_status(message, ok, "");
  EXPECT_GT(window_->count_pixels(is_red), 500U);
  set("Autocompute Range", false);
  set("Max Value", 1.0);
  expect_status(message, ok, "");
  EXPECT_EQ(window_->count_pixels(is_red), 0U);
}

TEST_F(DisplayTest, DefaultRadiusIsForMessagesWithout) {
  FiberArray message = cross();
  message.radii.clear();
  expect_status(message, ok, "");
  const std::size_t thin = window_->count_drawn();
  set("Default Radius", 0.05);
  ASSERT_TRUE(RvizWindow::wait_until([&] { return window_->count_drawn() > 2 * thin; }));
}

TEST_F(DisplayTest, ContactsOfTheSameStampColorSegments) {
  set("Color", QColor(0, 255, 0));
  set("Color By", "Distance");
  expect_status(cross(), ok, "");
  expect_contact_status(warning);
  set("Contact Topic", "contacts");
  ASSERT_TRUE(
      RvizWindow::wait_until([this] { return contact_publisher_.getNumSubscribers() == 1; }));

  ContactArray contacts;
  contacts.header = cross(2.0).header;
  contacts.margin = 0.1;
  contacts.contacts.resize(1);
  contacts.contacts[0].fiber_a = 0;
  contacts.contacts[0].segment_a = 0;
  contacts.contacts[0].fiber_b = 1;
  contacts.contacts[0].segment_b = 0;
  contacts.contacts[0].distance = -0.01;
  contact_publisher_.publish(contacts);
  expect_status(cross(2.0), ok, "");
  expect_contact_status(ok);
  EXPECT_GT(window_->count_pixels(is_red), 500U);
  EXPECT_GT(window_->count_pixels(is_green), 100U);

  // Those of another stamp do not.
  expect_status(cross(3.0), ok, "");
  expect_contact_status(warning);
  EXPECT_EQ(window_->count_pixels(is_red), 0U);

  // Those that name what is not there are told of.
  contacts.header = cross(4.0).header;
  contacts.contacts[0].segment_a = 2;
  contact_publisher_.publish(contacts);
  expect_status(cross(4.0), ok, "");
  expect_contact_status(error);
  EXPECT_NE(status("Contacts").text.find("segment 2 of fibre 0"), std::string::npos);
  EXPECT_EQ(window_->count_pixels(is_red), 0U);
}

TEST_F(DisplayTest, MalformedMessagesDrawNothingAndSayWhy) {
  const auto expect_error = [this](const char* text,
                                   const std::function<void(FiberArray&)>& spoil) {
    SCOPED_TRACE(text);
    expect_status(cross(), ok, "");
    EXPECT_GT(window_->count_drawn(), 0U);
    FiberArray message = cross();
    spoil(message);
    expect_status(message, error, text);
    EXPECT_EQ(window_->count_drawn(), 0U);
    // Nor does another look at it.
    set("Sides", display_.subProp("Sides")->getValue().toInt() + 1);
    window_->settle();
    EXPECT_EQ(status().level, error);
    EXPECT_EQ(window_->count_drawn(), 0U);
  };
  expect_error("offset", [](FiberArray& m) { m.offsets = {0, 3}; });
  expect_error("offset", [](FiberArray& m) { m.offsets = {0, 7, 5}; });
  expect_error("offset", [](FiberArray& m) { m.offsets = {0, 0xFFFFFFFF}; });
  expect_error("offset", [](FiberArray& m) { m.offsets.clear(); });
  expect_error("1 point(s)", [](FiberArray& m) { m.offsets = {0, 4, 5}; });
  expect_error("coordinates", [](FiberArray& m) { m.points[1].y = nan; });
  expect_error("coordinates", [](FiberArray& m) { m.points[4].x = HUGE_VAL; });
  expect_error("too far", [](FiberArray& m) { m.points[4].x = 1e16; });
  expect_error("radii", [](FiberArray& m) { m.radii = {-0.1}; });
  expect_error("radii", [](FiberArray& m) { m.radii = {0.1, 0.1, 0.1}; });
  expect_error("too thick", [](FiberArray& m) { m.radii = {1e16}; });
  expect_error("names", [](FiberArray& m) { m.names = {"one"}; });
}

TEST_F(DisplayTest, AMillionSegmentsAreRibbons) {
  FiberArray message = cross();
  message.points.clear();
  message.offsets = {0};
  for (int fiber = 0; fiber < 1000; ++fiber) {
    for (int i = 0; i <= 1000; ++i) {
      geometry_msgs::Point point;
      point.x = -0.5 + 0.001 * i;
      point.y = -0.5 + 0.001 * fiber;
      message.points.push_back(point);
    }
    message.offsets.push_back(static_cast<std::uint32_t>(message.points.size()));
  }
  expect_status(message, ok, "1000 fiber(s), 1000000 segment(s) as ribbons");
  EXPECT_GT(window_->count_drawn(), 1000U);
  set("Style", "Tubes");
  set("Sides", 32);
  ASSERT_TRUE(RvizWindow::wait_until([this] { return status().level == error; }));
  EXPECT_NE(status().text.find("too many"), std::string::npos) << status().text;
  EXPECT_EQ(window_->count_drawn(), 0U);
}

/// A coil of fine segments, as wide as the window is high.
FiberArray coil(double radius) {
  FiberArray message = cross();
  message.points.clear();
  constexpr int count = 20000;
  for (int i = 0; i < count; ++i) {
    geometry_msgs::Point point;
    point.x = 0.8 * std::cos(0.01 * i);
    point.y = 0.8 * std::sin(0.01 * i);
    point.z = -0.3 + 0.6 * i / count;
    message.points.push_back(point);
  }
  message.offsets = {0, count};
  message.radii = {radius};
  return message;
}

/// Part of the drawn pixels that differ by more than a quarter of the scale.
double difference(const std::vector<Pixel>& a, const std::vector<Pixel>& b) {
  std::size_t differing = 0;
  std::size_t drawn = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    int largest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      largest = std::max(largest, std::abs(a[i][k] - b[i][k]));
    }
    differing += largest > 64 ? 1 : 0;
    drawn += a[i] != Pixel{48, 48, 48} ? 1 : 0;
  }
  return static_cast<double>(differing) / static_cast<double>(drawn);
}

TEST_F(DisplayTest, LevelOfDetailIsNotToBeSeen) {
  set("Style", "Ribbons");
  for (const double radius : {0.001, 0.02}) {  // lines and ribbons
    SCOPED_TRACE(radius);
    set("Level of Detail", false);
    expect_status(coil(radius), ok, "19999 segment(s) as ribbons");
    const std::vector<Pixel> all = window_->picture();
    set("Level of Detail", true);
    window_->settle();
    // A line a pixel wide that is half of one beside its place.
    EXPECT_LT(difference(all, window_->picture()), 0.07);
    // But it is there: an error of many pixels shows.
    rviz::Property& pixel_error = *display_.subProp("Level of Detail")->subProp("Pixel Error");
    const QVariant before = pixel_error.getValue();
    pixel_error.setValue(30.0);
    window_->settle();
    EXPECT_GT(difference(all, window_->picture()), 0.1);
    pixel_error.setValue(before);
  }
}

TEST_F(DisplayTest, WhatComesBackIntoViewIsDrawnAsBefore) {
  set("Style", "Ribbons");
  const FiberArray message = coil(0.002);  // lines from afar, ribbons nearby
  expect_status(message, ok, "");
  const std::vector<Pixel> before = window_->picture();
  window_->look_at({0, 0, 100}, 3.0);
  window_->settle();
  EXPECT_EQ(window_->count_drawn(), 0U);
  window_->look_at({0, 0, 0}, 0.5);  // in the midst of it
  window_->settle();
  EXPECT_GT(window_->count_drawn(), 1000U);
  const std::vector<Pixel> nearby = window_->picture();
  expect_status(message, ok, "");  // what was made for afar is forgotten
  EXPECT_TRUE(window_->picture() == nearby);
  window_->look_at({0, 0, 0}, 3.0);
  window_->settle();
  EXPECT_TRUE(window_->picture() == before);
}

TEST_F(DisplayTest, DisabledItNeitherListensNorDraws) {
  expect_status(cross(), ok, "");
  display_.setEnabled(false);
  ASSERT_TRUE(RvizWindow::wait_until([this] { return publisher_.getNumSubscribers() == 0; }));
  EXPECT_EQ(window_->count_drawn(), 0U);
  display_.setEnabled(true);
  ASSERT_TRUE(RvizWindow::wait_until([this] { return publisher_.getNumSubscribers() == 1; }));
  expect_status(cross(), ok, "");
  EXPECT_GT(window_->count_drawn(), 0U);
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "display_test");
  testing::InitGoogleTest(&argc, argv);
  const QApplication application(argc, argv);
  return RUN_ALL_TESTS();
}

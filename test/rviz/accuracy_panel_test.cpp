// The panel beside a node: what is set by mouse and keyboard reaches the node, what the node
// answers is drawn, and what it refuses is told in its own words.
#include "src/rviz/accuracy_panel.hpp"

#include <gtest/gtest.h>
#include <ros/ros.h>

#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QElapsedTimer>
#include <QKeyEvent>
#include <QMouseEvent>
#include <memory>
#include <set>

#include "fiber_proximity/FiberArray.h"
#include "src/rviz/plot_axes.hpp"
#include "test/ros/messages.hpp"

namespace {

using fiber_proximity::FiberArray;
using fiber_proximity_rviz::AccuracyPanel;

/// Two fibres across each other, 27 mm apart.
FiberArray crossing_fibers() {
  test_messages::Points points{
      {-0.2, 0.0, 0.0}, {0.2, 0.0, 0.0}, {0.0, -0.2, 0.03}, {0.0, 0.2, 0.03}};
  FiberArray message =
      test_messages::fiber_array(test_messages::header("world", ros::Time::now()), points);
  message.offsets = {0, 2, 4};
  message.radii = {0.0015};
  return message;
}

void type(QWidget* control, const QString& text) {
  const auto press = [&](int key, Qt::KeyboardModifiers modifiers, const QString& letters) {
    QKeyEvent down(QEvent::KeyPress, key, modifiers, letters);
    QApplication::sendEvent(control, &down);
    QKeyEvent up(QEvent::KeyRelease, key, modifiers, letters);
    QApplication::sendEvent(control, &up);
  };
  press(Qt::Key_A, Qt::ControlModifier, "");
  for (const QChar& letter : text) {
    press(0, Qt::NoModifier, letter);
  }
  press(Qt::Key_Return, Qt::NoModifier, "\r");
}

void click(QWidget* control) {
  const QPointF at(8.0, control->height() / 2.0);
  QMouseEvent down(QEvent::MouseButtonPress, at, Qt::LeftButton, Qt::LeftButton, Qt::NoModifier);
  QApplication::sendEvent(control, &down);
  QMouseEvent up(QEvent::MouseButtonRelease, at, Qt::LeftButton, Qt::NoButton, Qt::NoModifier);
  QApplication::sendEvent(control, &up);
}

class AccuracyPanelTest : public testing::Test {
 protected:
  void SetUp() override {
    panel_.resize(360, 760);
    panel_.show();
    ASSERT_TRUE(wait_until([this] { return control<QComboBox>("kernel") != nullptr; }));
    ASSERT_TRUE(wait_until([this] { return publisher_.getNumSubscribers() > 0; }));
  }

  template <class Control>
  Control* control(const char* name) {
    return panel_.findChild<Control*>(name);
  }

  /// Publishes fibres meanwhile.
  bool wait_until(const std::function<bool()>& is_true) {
    QElapsedTimer timer;
    timer.start();
    while (!is_true()) {
      if (timer.elapsed() > 60000) {
        return false;
      }
      publisher_.publish(crossing_fibers());
      ros::spinOnce();
      QApplication::processEvents(QEventLoop::AllEvents, 10);
      ros::WallDuration(0.01).sleep();
    }
    return true;
  }

  template <class Value>
  bool node_has(const std::string& parameter, const Value& expected) {
    return wait_until([&] {
      Value value{};
      return ros::param::get("/proximity/" + parameter, value) && value == expected;
    });
  }

  QString status() { return control<QLabel>("status")->text(); }

  /// The number of the plot's pixels of a colour.
  int count_pixels(const QColor& color) {
    auto* plot = panel_.findChild<fiber_proximity_rviz::AnswerPlot*>("plot");
    const QImage image = plot->grab().toImage();
    int count = 0;
    for (int y = 0; y < image.height(); ++y) {
      for (int x = 0; x < image.width(); ++x) {
        count += static_cast<int>(image.pixelColor(x, y) == color);
      }
    }
    return count;
  }

  ros::NodeHandle node_;
  ros::Publisher publisher_{node_.advertise<FiberArray>("/fibers", 1)};
  AccuracyPanel panel_;
};

TEST_F(AccuracyPanelTest, WhatIsSetReachesTheNode) {
  control<QComboBox>("kernel")->setCurrentText("exact");
  EXPECT_TRUE(node_has<std::string>("kernel", "exact"));
  type(control<QLineEdit>("tolerance"), "0.002");
  EXPECT_TRUE(node_has("tolerance", 0.002));
  click(control<QCheckBox>("continuous"));
  EXPECT_TRUE(node_has("continuous", true));
  // Also what somebody else sets is shown.
  EXPECT_TRUE(wait_until([this] { return control<QCheckBox>("continuous")->isChecked(); }));
  EXPECT_EQ(std::system("rosrun dynamic_reconfigure dynparam set /proximity margin 0.2"), 0);
  EXPECT_TRUE(wait_until([this] { return control<QLineEdit>("margin")->text() == "0.2"; }));
}

TEST_F(AccuracyPanelTest, WhatTheNodeRefusesIsToldInItsOwnWords) {
  int polls = 0;
  EXPECT_TRUE(wait_until([&] {
    if (polls++ % 100 == 0) {  // the panel may not be connected to the node's log yet
      type(control<QLineEdit>("margin"), "-1");
    }
    return status().contains("margin is -1, it must be a number of at least 0");
  })) << status().toStdString();
  EXPECT_TRUE(wait_until([this] { return control<QLineEdit>("margin")->text() != "-1"; }));
  type(control<QLineEdit>("margin"), "wide");
  EXPECT_EQ(status(), "margin: wide is not a number");
  EXPECT_NE(control<QLineEdit>("margin")->text(), "wide");
}

TEST_F(AccuracyPanelTest, AnswersAreDrawnWhileTheyCome) {
  const QColor contacts(0, 158, 115);
  const QColor known(0, 114, 178);
  EXPECT_TRUE(wait_until([&] { return count_pixels(known) > 20; }));
  const int before = count_pixels(known);
  EXPECT_TRUE(wait_until([&] { return count_pixels(known) > before + 20; })) << "it stands still";
  EXPECT_GT(count_pixels(contacts), 0);
}

TEST_F(AccuracyPanelTest, SettingsAreMeasuredAndDrawn) {
  auto* button = control<QPushButton>("measure");
  click(button);
  EXPECT_FALSE(button->isEnabled()) << "one at a time";
  EXPECT_TRUE(wait_until([&] { return button->isEnabled(); }));
  EXPECT_EQ(status(), "");
  auto* chart = control<fiber_proximity_rviz::SettingsChart>("chart of all");
  EXPECT_TRUE(chart->isVisible());
  const QImage image = chart->grab().toImage();
  std::set<QRgb> colors;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) {
      colors.insert(image.pixel(x, y));
    }
  }
  EXPECT_EQ(colors.count(fiber_proximity_rviz::plot_color(0).rgb()), 1U) << "the kernel robust";
  EXPECT_GT(colors.size(), 5U);
  EXPECT_NE(control<fiber_proximity_rviz::SettingsChart>("chart of closest"), nullptr);
}

TEST_F(AccuracyPanelTest, ANodeThatIsNotThereIsWaitedFor) {
  type(control<QLineEdit>("node"), "/nobody");
  EXPECT_EQ(status(), "waiting for node /nobody");
  EXPECT_EQ(control<QComboBox>("kernel"), nullptr);
  type(control<QLineEdit>("node"), "no name");
  EXPECT_TRUE(status().startsWith("'no name' is no node's name")) << status().toStdString();
  type(control<QLineEdit>("node"), "/proximity");
  EXPECT_TRUE(wait_until([this] { return control<QComboBox>("kernel") != nullptr; }));
}

TEST_F(AccuracyPanelTest, ItsNodeIsSaved) {
  type(control<QLineEdit>("node"), "/another");
  rviz::Config config;
  panel_.save(config);
  AccuracyPanel loaded;
  loaded.load(config);
  EXPECT_EQ(loaded.findChild<QLineEdit*>("node")->text(), "/another");
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  QApplication application(argc, argv);
  ros::init(argc, argv, "accuracy_panel_test", ros::init_options::NoSigintHandler);
  const ros::NodeHandle node;
  return RUN_ALL_TESTS();
}

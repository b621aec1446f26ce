// How fast rviz draws one scene, in turns: as our display with all points, with fewer of them, and
// as a marker; from where all of it is in the window, and from a third of that distance. Needs a
// ROS master and a display: scripts/display_rate.sh has both.
//   display_rate SCENE SCALE FRAMES TURNS
#include <ros/ros.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Geometry>
#include <QApplication>
#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "fiber_proximity/FiberArray.h"
#include "fiber_proximity/ros/conversions.hpp"
#include "fiber_proximity/scenes/scene.hpp"
#include "src/ros/support/stopwatch.hpp"
#include "validation/rviz/rviz_window.hpp"

namespace {

using fiber::FiberAssembly;
using fiber_proximity::FiberArray;
using fiber_proximity_ros::Stopwatch;
using rviz_test::RvizWindow;
using visualization_msgs::MarkerArray;

FiberArray::Ptr as_fibers(const FiberAssembly& fibers) {
  auto message = boost::make_shared<FiberArray>();
  fiber_proximity_ros::to_message(fibers, {}, *message);
  message->header.frame_id = "world";
  return message;
}

MarkerArray::Ptr as_marker(const FiberAssembly& fibers) {
  auto message = boost::make_shared<MarkerArray>();
  visualization_msgs::Marker& marker = message->markers.emplace_back();
  marker.header.frame_id = "world";
  marker.type = visualization_msgs::Marker::LINE_LIST;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = 2.0 * fibers.segment_radius(0);
  marker.color.a = marker.color.r = 1.0F;
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::uint32_t p = fibers.offsets()[fiber]; p + 1 < fibers.offsets()[fiber + 1]; ++p) {
      marker.points.push_back(fiber_proximity_ros::to_message(fibers.points()[p]));
      marker.points.push_back(fiber_proximity_ros::to_message(fibers.points()[p + 1]));
    }
  }
  return message;
}

using Picture = std::vector<rviz_test::Pixel>;

/// Where the scene is looked at from.
struct View {
  const char* name;
  double distance;  // [m] from the middle
};

class Comparison {
 public:
  Comparison(const FiberAssembly& fibers, int frames)
      : fibers_(as_fibers(fibers)), marker_(as_marker(fibers)), frames_(frames) {
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& point : fibers.points()) {
      box.extend(point);
    }
    middle_ = box.center();
    // rviz's window is 45 degrees high.
    const double whole = 0.5 * box.diagonal().norm() / std::sin(M_PI / 8.0);
    views_ = {{"whole", whole}, {"near", whole / 3.0}};
  }

  void run_turn() {
    const std::vector<Picture> all = show_fibers("all points", false);
    const std::vector<Picture> fewer = show_fibers("level of detail", true);
    for (std::size_t i = 0; i < views_.size(); ++i) {
      std::printf("%s: %.2f %% of the pixels differ, %.2f %% by more than an eighth\n",
                  views_[i].name, 100.0 * differing(all[i], fewer[i], 0),
                  100.0 * differing(all[i], fewer[i], 32));
    }
    rviz::Display& display = window_.add("rviz/MarkerArray");
    show("marker", display, "Marker Topic", marker_, "OK");
  }

 private:
  std::vector<Picture> show_fibers(const char* name, bool is_reduced) {
    rviz::Display& display = window_.add("fiber_proximity/FiberArray");
    display.subProp("Level of Detail")->setValue(is_reduced);
    return show(name, display, "Topic", fibers_, "segment(s)");
  }

  /// Prints how long it took until the picture with the message was there, and from each view the
  /// time and the processors' work for each further one.
  /// @param words what the display says of itself once it draws the message
  template <class Message>
  std::vector<Picture> show(const char* name, rviz::Display& display, const char* topic_property,
                            const boost::shared_ptr<Message>& message, const char* words) {
    window_.look_at(middle_, views_.front().distance);
    const ros::Publisher publisher = ros::NodeHandle().advertise<Message>("shown", 1);
    display.subProp(topic_property)->setValue("shown");
    RvizWindow::wait_until([&] { return publisher.getNumSubscribers() > 0; });
    const Stopwatch first;
    publisher.publish(message);
    const auto is_shown = [&] {
      return RvizWindow::status(display, "Fibers").text.find(words) != std::string::npos ||
             RvizWindow::status(display, "Topic").text == words;
    };
    if (!RvizWindow::wait_until(is_shown)) {
      throw std::runtime_error(std::string(name) + " was not drawn");
    }
    window_.draw();
    std::printf("%s: first picture %.0f ms", name, 1e3 * first.seconds());
    std::vector<Picture> pictures;
    for (const View& view : views_) {
      window_.look_at(middle_, view.distance);
      window_.settle();
      const Stopwatch others;
      const std::clock_t begin = std::clock();
      for (int i = 0; i < frames_; ++i) {
        window_.draw();
      }
      const double seconds = others.seconds() / frames_;
      const double work = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / frames_;
      std::printf("; %s %.0f ms each, %.0f ms of work", view.name, 1e3 * seconds, 1e3 * work);
      pictures.push_back(window_.picture());
    }
    std::printf("\n");
    std::fflush(stdout);
    window_.remove(display);
    return pictures;
  }

  /// Part of the pixels of which a colour differs by more than this, of 255.
  static double differing(const Picture& a, const Picture& b, int most) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      int largest = 0;
      for (std::size_t k = 0; k < a[i].size(); ++k) {
        largest = std::max(largest, std::abs(a[i][k] - b[i][k]));
      }
      count += largest > most ? 1 : 0;
    }
    return static_cast<double>(count) / static_cast<double>(a.size());
  }

  RvizWindow window_{1280, 800};
  FiberArray::Ptr fibers_;
  MarkerArray::Ptr marker_;
  int frames_;
  Eigen::Vector3d middle_;
  std::vector<View> views_;
};

int run(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: display_rate SCENE SCALE FRAMES TURNS\n");
    return 2;
  }
  fiber::SceneOptions options;
  options.scale = std::stod(argv[2]);
  const FiberAssembly fibers = fiber::make_scene(argv[1], options)(0);
  std::printf("%s: %zu fiber(s), %zu segment(s)\n", argv[1], fibers.fiber_count(),
              fibers.segment_count());
  Comparison comparison(fibers, std::max(1, std::stoi(argv[3])));
  for (int turn = std::stoi(argv[4]); turn > 0; --turn) {
    comparison.run_turn();
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    ros::init(argc, argv, "display_rate");
    const QApplication application(argc, argv);
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "display_rate: %s\n", error.what());
    return 1;
  }
}

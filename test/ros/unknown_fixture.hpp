#pragma once

#include <diagnostic_msgs/DiagnosticArray.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <cmath>
#include <functional>
#include <map>

#include "fiber_proximity/AllowPairs.h"
#include "fiber_proximity/ObstacleArray.h"
#include "fiber_proximity/TimeToContact.h"
#include "test/ros/messages.hpp"
#include "test/ros/simulated_time_test.hpp"
#include "test/ros/unknown_verdicts.hpp"

/// Sources that fail, and what the outputs and services of the running node say meanwhile: as in
/// unknown.test.
namespace unknown_test {

using fiber_proximity::ContactArray;
using fiber_proximity::ObstacleArray;
using fiber_proximity::TimeToContact;
using sensor_msgs::PointCloud2;
using visualization_msgs::MarkerArray;

enum class Fault {
  NONE,
  SILENCE,       // never came, or stopped
  REFUSED,       // malformed
  UNKNOWN_TF,    // in a frame that nobody has heard of
  OLD_TF,        // tf does not go on to its stamp
  NOT_CONNECTED  // in a frame that tf knows nowhere near the fixed one
};

inline std::string name_of(Fault fault) {
  static const char* const names[] = {"none",       "silence", "refused",
                                      "unknown tf", "old tf",  "not connected"};
  return names[static_cast<int>(fault)];
}

/// The frame that a message of this fault is in.
inline std::string frame_of(Fault fault) {
  switch (fault) {
    case Fault::UNKNOWN_TF:
      return "nowhere";
    case Fault::OLD_TF:
      return "frozen";
    case Fault::NOT_CONNECTED:
      return "adrift";
    default:
      return "world";
  }
}

/// Where answers come from.
struct Source {
  std::string name;    // in what is unknown
  std::string status;  // on /diagnostics
  bool is_of_fibers;
  std::vector<Fault> faults;  // once it has been heard
  std::function<void(Fault)> send;
  Fault fault = Fault::SILENCE;
};

class UnknownTest : public node_test::SimulatedTimeTest {
 protected:
  UnknownTest() {
    a_ = advertise<FiberArray>("/a");
    b_ = advertise<FiberArray>("/b");
    cloud_ = advertise<PointCloud2>("/proximity/cloud");
    bodies_ = advertise<MarkerArray>("/bodies");
    obstacles_ = advertise<ObstacleArray>("/proximity/obstacles");
    geometry_msgs::TransformStamped frozen = transform("world", "frozen", now());
    transforms_.sendTransform(frozen);
    const std::vector<Fault> all{Fault::SILENCE, Fault::REFUSED, Fault::UNKNOWN_TF, Fault::OLD_TF,
                                 Fault::NOT_CONNECTED};
    // What was sent once stays: that a topic of obstacles falls silent is no fault.
    const std::vector<Fault> of_changes{Fault::REFUSED, Fault::UNKNOWN_TF, Fault::OLD_TF,
                                        Fault::NOT_CONNECTED};
    sources_ = {
        {"input /a", "input /a", true, all, [this](Fault fault) { send_fibers(a_, 0.0, fault); }},
        {"input /b", "input /b", true, all, [this](Fault fault) { send_fibers(b_, 1.0, fault); }},
        {"robot/tool",
         "environment robot",
         false,
         {Fault::SILENCE, Fault::OLD_TF, Fault::NOT_CONNECTED},
         [this](Fault fault) { send_link(fault); }},
        {"cloud", "environment /proximity/cloud", false, all,
         [this](Fault fault) { send_cloud(fault); }},
        {"bodies/0", "environment /bodies", false, of_changes,
         [this](Fault fault) { send_marker(fault); }},
        {"ball", "environment /proximity/obstacles", false, of_changes,
         [this](Fault fault) { send_obstacle(fault); }},
        {"shelf", "environment scene", false, {}, [this](Fault fault) { send_wall(fault); }},
    };
  }

  geometry_msgs::TransformStamped transform(const std::string& parent, const std::string& child,
                                            const ros::Time& stamp) {
    geometry_msgs::TransformStamped transform;
    transform.header = header(parent, stamp);
    transform.child_frame_id = child;
    transform.transform.translation.y = 5.0;
    transform.transform.rotation.w = 1.0;
    return transform;
  }

  void send_fibers(const ros::Publisher& publisher, double x, Fault fault) {
    FiberArray message =
        test_messages::fiber_array(header(frame_of(fault), now()), {{x, 0, 0}, {x, 0, 1}});
    if (fault == Fault::REFUSED) {
      message.points[1].y = std::nan("");
    }
    publisher.publish(message);
  }

  void send_link(Fault fault) {
    const ros::Time stamp = fault == Fault::OLD_TF ? now() - ros::Duration(5.0) : now();
    transforms_.sendTransform(
        transform(fault == Fault::NOT_CONNECTED ? "raft" : "world", "tool", stamp));
  }

  void send_cloud(Fault fault) {
    PointCloud2 message = test_messages::point_cloud2(header(frame_of(fault), now()), {{0, 9, 0}});
    if (fault == Fault::REFUSED) {
      message.fields.clear();
    }
    cloud_.publish(message);
  }

  void send_marker(Fault fault) {
    using visualization_msgs::Marker;
    MarkerArray message;
    message.markers.push_back(
        test_messages::marker(header(frame_of(fault), now()), Marker::CUBE, {}));
    message.markers[0].ns = "bodies";
    message.markers[0].pose.position.y = -9.0;
    if (fault == Fault::REFUSED) {
      message.markers[0].scale.x = -1.0;
    }
    bodies_.publish(message);
  }

  void send_obstacle(Fault fault) {
    ObstacleArray message;
    message.obstacles.push_back(test_messages::ball("ball", -9.0, 0.1, frame_of(fault)));
    message.obstacles[0].header.stamp = now();
    if (fault == Fault::REFUSED) {
      message.obstacles[0].primitives[0].dimensions.clear();
    }
    obstacles_.publish(message);
  }

  void send_wall(Fault fault) {
    if (fault == Fault::NONE) {
      static_transforms_.sendTransform(transform("world", "wall", now()));
    }
  }

  /// All that is sent, as time goes on.
  void step() {
    transforms_.sendTransform(transform("raft", "adrift", now()));
    for (const Source& source : sources_) {
      if (source.fault != Fault::SILENCE) {
        source.send(source.fault);
      }
    }
    pass(0.05);
  }

  /// Returns what the newest message of each output says.
  std::map<std::string, std::pair<About, Verdict>> verdicts() const {
    std::map<std::string, std::pair<About, Verdict>> verdicts;
    const auto of_array = [](const ContactArray& answer) {
      return Verdict{answer.complete != 0, answer.minimum_lower > -infinity, answer.unknown};
    };
    if (!contacts.messages.empty()) {
      verdicts.emplace("contacts",
                       std::make_pair(About::FIBERS, of_array(*contacts.messages.back())));
    }
    if (!around_.messages.empty()) {
      verdicts.emplace("environment_contacts",
                       std::make_pair(About::BOTH, of_array(*around_.messages.back())));
    }
    if (!times_.messages.empty()) {
      const TimeToContact& told = *times_.messages.back();
      const auto of_part = [&told](const fiber_proximity::PredictedContact& part) {
        return Verdict{part.complete != 0, part.time_lower > 0.0, told.unknown};
      };
      verdicts.emplace("time_to_contact",
                       std::make_pair(About::BOTH, Verdict{told.complete != 0, told.complete != 0,
                                                           told.unknown}));
      verdicts.emplace("time_to_contact environment",
                       std::make_pair(About::BOTH, of_part(told.environment)));
      for (const auto* part : {&told.same_fiber, &told.different_fibers}) {
        Verdict verdict = of_part(*part);
        if (verdict.is_complete) {
          verdict.unknown.clear();  // those are of the environment
        }
        verdicts.emplace(part == &told.same_fiber ? "time_to_contact same fibre"
                                                  : "time_to_contact different fibres",
                         std::make_pair(About::FIBERS, verdict));
      }
    }
    if (!statistics.messages.empty()) {
      const fiber_proximity::Statistics& told = *statistics.messages.back();
      verdicts.emplace("statistics",
                       std::make_pair(About::BOTH, Verdict{told.complete != 0, told.complete != 0,
                                                           told.unknown}));
    }
    ask_services(verdicts);
    return verdicts;
  }

  static bool depends(About about, const Source& source) {
    return about == About::BOTH ||
           about == (source.is_of_fibers ? About::FIBERS : About::ENVIRONMENT);
  }

  /// Why the answers are not those of a node that lacks these sources and no others; empty if they
  /// are.
  std::string problem(const std::vector<const Source*>& lacking) const {
    const auto verdicts = this->verdicts();
    if (verdicts.size() < 6) {
      return "too few answers";
    }
    for (const auto& [output, answer] : verdicts) {
      const auto& [about, verdict] = answer;
      bool is_complete = true;
      for (const Source* source : lacking) {
        if (depends(about, *source)) {
          is_complete = false;
          if (!verdict.names(source->name)) {
            return output + " does not say that " + source->name + " is unknown";
          }
        }
      }
      if (verdict.is_complete != is_complete || verdict.is_free != is_complete ||
          verdict.unknown.empty() != is_complete) {
        return output +
               (is_complete ? " is incomplete, for "
                            : " is complete or free without what it is about, for ") +
               (verdict.unknown.empty() ? "nothing" : verdict.unknown.front());
      }
    }
    for (const Source& source : sources_) {
      const bool is_lacking = std::any_of(lacking.begin(), lacking.end(),
                                          [&](const Source* each) { return each == &source; });
      const int level = level_of(source.status);
      if (is_lacking ? level == 0 : level > 0 && source.fault == Fault::NONE) {
        return "/diagnostics has the level " + std::to_string(level) + " for " + source.status;
      }
    }
    return "";
  }

  /// The level of the newest report; -1 if there is none.
  int level_of(const std::string& name) const {
    if (!diagnostics_.messages.empty()) {
      for (const auto& status : diagnostics_.messages.back()->status) {
        if (status.name == "proximity: " + name) {
          return status.level;
        }
      }
    }
    return -1;
  }

  /// Goes on until the answers are those, and a while longer.
  void expect(const std::vector<const Source*>& lacking) {
    std::string why;
    ASSERT_TRUE(node_test::wait_for([&] {
      step();
      why = problem(lacking);
      return why.empty();
    })) << why;
    for (int i = 0; i < 10; ++i) {
      step();
      ASSERT_EQ(problem(lacking), "") << "not for good";
    }
  }

  void heal_all() {
    for (Source& source : sources_) {
      source.fault = Fault::NONE;
    }
    expect({});
  }

  std::vector<Source> sources_;
  node_test::Recorder<ContactArray> around_{node, "/proximity/environment_contacts"};
  node_test::Recorder<TimeToContact> times_{node, "/proximity/time_to_contact"};
  node_test::Recorder<diagnostic_msgs::DiagnosticArray> diagnostics_{node, "/diagnostics"};
  tf2_ros::TransformBroadcaster transforms_;
  tf2_ros::StaticTransformBroadcaster static_transforms_;
  ros::Publisher a_;
  ros::Publisher b_;
  ros::Publisher cloud_;
  ros::Publisher bodies_;
  ros::Publisher obstacles_;
};

}  // namespace unknown_test

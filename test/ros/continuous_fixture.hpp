#pragma once

#include <dynamic_reconfigure/Reconfigure.h>

#include <string>
#include <vector>

#include "fiber_proximity/ContactEvent.h"
#include "fiber_proximity/Obstacle.h"
#include "fiber_proximity/TimeToContact.h"
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

/// The running node with ~continuous, as in continuous.test.
namespace continuous_test {

using Eigen::Vector3d;
using fiber_proximity::Contact;
using fiber_proximity::ContactArray;
using fiber_proximity::ContactEvent;
using fiber_proximity::FiberArray;
using fiber_proximity::TimeToContact;

constexpr double radius = 0.001;  // [m] as in continuous.test
inline const ros::Duration frame_time(0.1);

/// A cable along x, and one across it at (x, 0, z).
inline FiberArray crossed(double x, double z) {
  FiberArray message = test_messages::fiber_array(test_messages::header("world"), {{-0.5, 0, 0},
                                                                                   {-0.25, 0, 0},
                                                                                   {0, 0, 0},
                                                                                   {0.25, 0, 0},
                                                                                   {0.5, 0, 0},
                                                                                   {x, -0.3, z},
                                                                                   {x, 0.3, z}});
  message.offsets = {0, 5, 7};
  message.names = {"along", "across"};
  return message;
}

/// 2 cm wide, 1 mm thick.
inline fiber_proximity::Obstacle plate(const Vector3d& center) {
  fiber_proximity::Obstacle obstacle;
  obstacle.header.frame_id = "world";
  obstacle.id = "plate";
  obstacle.operation = fiber_proximity::Obstacle::ADD;
  obstacle.pose.orientation.w = 1.0;
  obstacle.pose.position = fiber_proximity_ros::to_message(center);
  obstacle.primitives.resize(1);
  obstacle.primitives[0].type = shape_msgs::SolidPrimitive::BOX;
  obstacle.primitives[0].dimensions = {0.02, 0.02, 0.001};
  obstacle.primitive_poses.resize(1);
  obstacle.primitive_poses[0].orientation.w = 1.0;
  return obstacle;
}

/// Stamps are a tenth of a second apart, whenever messages are sent.
class ContinuousTest : public node_test::NodeTest {
 protected:
  void SetUp() override {
    cables_ = advertise<FiberArray>("/cables");
    double z = 0.1;
    const auto is_answer = [](const auto& answer) { return !answer.fiber_names.empty(); };
    ASSERT_TRUE(node_test::wait_for([&] {
      publish(crossed(0.1, z = -z));
      ros::WallDuration(0.02).sleep();
      return contacts.find(is_answer) != nullptr && times_.find(is_answer) != nullptr &&
             !statistics.messages.empty() && !events_.messages.empty();
    })) << "the node does not answer";
    z_ = z;
    ASSERT_NE(answer_to(crossed(0.1, z)), nullptr);  // and it stands still
    ASSERT_NE(answer_to(crossed(0.1, z)), nullptr);
    events_.messages.clear();
  }

  /// @param later [s] than the message before
  ros::Time publish(FiberArray message, ros::Duration later = frame_time) {
    static ros::Time last = ros::Time::now() - ros::Duration(20000);
    last += later;
    message.header.stamp = last;
    cables_.publish(message);
    return last;
  }

  const ContactArray* answer_to(const FiberArray& message, ros::Duration later = frame_time) {
    return contacts.wait_for(publish(message, later));
  }

  /// An answer is of its stamp alone, for a reason; the next one is continuous again.
  void expect_discrete(const ContactArray* answer, const std::string& reason,
                       const FiberArray& message) {
    ASSERT_NE(answer, nullptr);
    EXPECT_FALSE(answer->continuous);
    EXPECT_EQ(answer->since, answer->header.stamp);
    for (const Contact& contact : answer->contacts) {
      EXPECT_FALSE(contact.gone);
    }
    const fiber_proximity::Statistics* const told = statistics.wait_for(answer->header.stamp);
    ASSERT_NE(told, nullptr);
    EXPECT_GT(told->discrete_answers, 0U);
    EXPECT_NE(told->discrete_reason.find(reason), std::string::npos) << told->discrete_reason;
    const ContactArray* const next = answer_to(message);
    ASSERT_NE(next, nullptr);
    EXPECT_TRUE(next->continuous);
    EXPECT_EQ(statistics.wait_for(next->header.stamp)->discrete_reason, "");
  }

  /// Until the node has logged why it refuses a message: sent before, the next one might take its
  /// place.
  void await_refusal(const std::string& reason) const {
    ASSERT_TRUE(node_test::wait_for([&] { return !logs_of(reason).empty(); })) << reason;
  }

  /// Why the latest message was refused, as the statistics of an answer tell it.
  std::string refusal_before(const ContactArray& answer) const {
    const fiber_proximity::Statistics* const told = statistics.wait_for(answer.header.stamp);
    const fiber_proximity::InputStatistics* const input =
        told == nullptr ? nullptr : input_of(*told, "/cables");
    return input == nullptr ? "" : input->last_error;
  }

  /// All events up to an answer have come.
  std::vector<ContactEvent> events_until(const ros::Time& stamp, std::size_t count) {
    std::vector<ContactEvent> found;
    node_test::wait_for([&] { return events_.messages.size() >= count; });
    for (const auto& event : events_.messages) {
      if (event->header.stamp == stamp) {
        found.push_back(*event);
      }
    }
    events_.messages.clear();
    return found;
  }

  /// [s] of a time after the frame before an answer.
  static double after(const ros::Time& time, const ContactArray& answer) {
    return (time - (answer.header.stamp - frame_time)).toSec();
  }

  void set(const std::string& name, bool value) {
    dynamic_reconfigure::Reconfigure request;
    dynamic_reconfigure::BoolParameter parameter;
    parameter.name = name;
    parameter.value = value;
    request.request.config.bools.push_back(parameter);
    ASSERT_TRUE(node_test::call_service("/proximity/set_parameters", request));
  }

  ros::Publisher cables_;
  double z_ = 0.0;  // [m] of the cable across, at first
  node_test::Recorder<ContactEvent> events_{node, "/proximity/contact_events"};
  node_test::Recorder<TimeToContact> times_{node, "/proximity/time_to_contact"};
};

}  // namespace continuous_test

#pragma once

#include <gtest/gtest.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>

#include <algorithm>
#include <functional>
#include <map>
#include <mutex>
#include <numeric>
#include <string>
#include <vector>

#include "fiber_proximity/ContactArray.h"
#include "fiber_proximity/FiberArray.h"
#include "fiber_proximity/QueryProximity.h"
#include "fiber_proximity/Statistics.h"
#include "fiber_proximity/ros/conversions.hpp"
#include "test/support/answers.hpp"

/// Tools that tests of the running node share. The node under test is /proximity.
namespace node_test {

/// [s] that only a broken node needs, however busy the machine is.
constexpr double patience = 120.0;

/// Handles callbacks until the condition holds.
/// @returns false if it does not within our patience
inline bool wait_for(const std::function<bool()>& condition) {
  const ros::SteadyTime begin = ros::SteadyTime::now();
  while (!condition()) {
    if (!ros::ok() || (ros::SteadyTime::now() - begin).toSec() > patience) {
      return false;
    }
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
  }
  return true;
}

/// Calls a service as soon as there is one. All calls of a program to a service that goes on share
/// a connection: ros::service::call() makes a new one for each, as does waitForService(), and on a
/// busy machine one of thousands of these is lost without a word.
template <class Service>
bool call_service(const std::string& name, Service& service) {
  static std::mutex mutex;
  // Never taken apart: ROS has ended by then.
  static auto& clients = *new std::map<std::string, ros::ServiceClient>;
  ros::ServiceClient client;
  {
    const std::lock_guard<std::mutex> lock(mutex);
    ros::ServiceClient& known = clients[name];
    if (!known.isValid()) {
      if (!ros::service::waitForService(name, ros::Duration(patience))) {
        return false;
      }
      known = ros::service::createClient<Service>(name, true);
    }
    client = known;
  }
  return client.call(service);
}

/// Calls a service over a connection of its own, beside other calls to it. The connection is asked
/// to stay: one that the server closes behind its answer may lose that answer on a busy machine.
template <class Service>
bool call_service_alone(const std::string& name, Service& service) {
  return ros::service::createClient<Service>(name, true).call(service);
}

/// Advertises a topic, which stays advertised for all tests of a program: on a busy machine the
/// master tells subscribers late that a topic is gone, and they drop the next publisher's
/// connection with what is sent over it.
template <class Message>
ros::Publisher advertise(ros::NodeHandle& node, const std::string& topic) {
  // Never taken apart: ROS has ended by then.
  static auto& publishers = *new std::map<std::string, ros::Publisher>;
  ros::Publisher& known = publishers[node.resolveName(topic)];
  if (!known) {
    known = node.advertise<Message>(topic, 1000);
  }
  return known;
}

/// tf's broadcaster, which stays for all tests of a program as publishers do.
template <class Broadcaster>
Broadcaster& broadcaster() {
  static auto& one = *new Broadcaster;
  return one;
}

/// Keeps all messages of a topic.
template <class Message>
class Recorder {
 public:
  using Pointer = boost::shared_ptr<const Message>;

  Recorder(ros::NodeHandle& node, const std::string& topic)
      : subscriber_(node.subscribe<Message>(
            topic, 1000, [this](const Pointer& message) { messages.push_back(message); })) {}

  const Message* find(const std::function<bool(const Message&)>& condition) const {
    for (const Pointer& message : messages) {
      if (condition(*message)) {
        return message.get();
      }
    }
    return nullptr;
  }

  /// Waits for a message that meets the condition; nullptr if none comes.
  const Message* wait_for(const std::function<bool(const Message&)>& condition) const {
    const Message* found = nullptr;
    node_test::wait_for([&] { return (found = find(condition)) != nullptr; });
    return found;
  }

  /// Waits for the message with this stamp.
  const Message* wait_for(const ros::Time& stamp) const {
    return wait_for([stamp](const Message& message) { return message.header.stamp == stamp; });
  }

  /// For messages that nobody sends again. @returns whether the publisher is there
  bool wait_for_connection() const {
    return node_test::wait_for([&] { return subscriber_.getNumPublishers() > 0; });
  }

  std::vector<Pointer> messages;

 private:
  ros::Subscriber subscriber_;
};

/// Records what the node says, and logs.
class NodeTest : public ::testing::Test {
 protected:
  NodeTest() {
    // What is logged is logged once: the connections to those who log stay for all tests.
    static auto& connection = *new ros::Subscriber(node.subscribe<rosgraph_msgs::Log>(
        "/rosout", 1000,
        boost::function<void(const rosgraph_msgs::LogConstPtr&)>([](const auto& /*log*/) {})));
    static_cast<void>(connection);
  }

  template <class Message>
  ros::Publisher advertise(const std::string& topic) {
    const ros::Publisher publisher = node_test::advertise<Message>(node, topic);
    EXPECT_TRUE(wait_for([&] { return publisher.getNumSubscribers() > 0; }))
        << "nobody listens to " << topic;
    return publisher;
  }

  /// Publishes messages with new stamps until all recorders have seen an answer to one, and another
  /// one has if there is one.
  template <class Message>
  void connect(
      const ros::Publisher& publisher, Message message,
      const std::function<bool()>& has_answer = [] { return true; }) {
    ros::SteadyTime last;
    const ros::Time begin = new_stamp();
    const auto is_answer = [&begin](const auto& answer) { return answer.header.stamp > begin; };
    ASSERT_TRUE(wait_for([&] {
      const ros::SteadyTime now = ros::SteadyTime::now();
      if ((now - last).toSec() > 0.2) {
        last = now;
        message.header.stamp = new_stamp();
        publisher.publish(message);
      }
      return contacts.find(is_answer) != nullptr && fibers.find(is_answer) != nullptr &&
             statistics.find(is_answer) != nullptr && has_answer();
    })) << "the node does not answer";
    ASSERT_NE(contacts.wait_for(message.header.stamp), nullptr);
    ASSERT_NE(statistics.wait_for(message.header.stamp), nullptr);
  }

  /// Now, and later than all stamps before.
  static ros::Time new_stamp() {
    static ros::Time last;
    last = std::max(ros::Time::now(), last + ros::Duration(0, 1));
    return last;
  }

  /// The errors and warnings that name this.
  std::vector<std::string> logs_of(const std::string& what) const {
    std::vector<std::string> found;
    for (const auto& log : logs.messages) {
      if (log->level >= rosgraph_msgs::Log::WARN && log->msg.find(what) != std::string::npos) {
        found.push_back(log->msg);
      }
    }
    return found;
  }

  /// Waits for an error or a warning that has this text.
  void expect_log(const std::string& text) const {
    EXPECT_TRUE(wait_for([&] { return !logs_of(text).empty(); })) << text;
  }

  /// Checks what holds of every answer, whatever it is about.
  void TearDown() override {
    for (const auto& answer : contacts.messages) {
      EXPECT_EQ(answer->complete != 0, answer->unknown.empty());
    }
    for (const auto& told : statistics.messages) {
      EXPECT_EQ(told->complete != 0, told->unknown.empty());
      ASSERT_EQ(told->parts.size(), told->part_times.size());
      const double sum = std::accumulate(told->part_times.begin(), told->part_times.end(), 0.0);
      EXPECT_LE(sum, told->total_time * (1.0 + 1e-9)) << "parts take longer than the whole";
    }
  }

  static const fiber_proximity::InputStatistics* input_of(
      const fiber_proximity::Statistics& statistics, const std::string& topic) {
    for (const fiber_proximity::InputStatistics& input : statistics.inputs) {
      if (input.topic == topic) {
        return &input;
      }
    }
    ADD_FAILURE() << "no input " << topic;
    return nullptr;
  }

  ros::NodeHandle node;
  Recorder<fiber_proximity::ContactArray> contacts{node, "/proximity/contacts"};
  Recorder<fiber_proximity::FiberArray> fibers{node, "/proximity/fibers"};
  Recorder<fiber_proximity::Statistics> statistics{node, "/proximity/statistics"};
  Recorder<rosgraph_msgs::Log> logs{node, "/rosout"};
};

inline fiber::FiberAssembly to_assembly(const fiber_proximity::FiberArray& message) {
  fiber_proximity_ros::FiberBuffer buffer;
  fiber_proximity_ros::to_chains(message, buffer);
  return {buffer.points, buffer.offsets, buffer.radii};
}

inline void expect_same(const fiber_proximity::Contact& message, const fiber::Contact& contact) {
  EXPECT_EQ(message.fiber_a, contact.fiber_a);
  EXPECT_EQ(message.segment_a, contact.segment_a);
  EXPECT_EQ(message.fiber_b, contact.fiber_b);
  EXPECT_EQ(message.segment_b, contact.segment_b);
  EXPECT_EQ(message.s, contact.s);
  EXPECT_EQ(message.t, contact.t);
  EXPECT_EQ(message.distance, contact.distance);
  EXPECT_EQ(message.lower, contact.lower);
  EXPECT_EQ(message.upper, contact.upper);
  EXPECT_EQ(fiber_proximity_ros::to_vector(message.point_a), contact.point_a);
  EXPECT_EQ(fiber_proximity_ros::to_vector(message.point_b), contact.point_b);
  EXPECT_EQ(fiber_proximity_ros::to_vector(message.normal), contact.normal);
}

/// Compares an answer, pair for pair and bit for bit, with brute force over the fibres it is about.
/// @param options of the node, where they are not the defaults; the message tells the margin
inline void expect_brute_force(const fiber_proximity::ContactArray& message,
                               const fiber_proximity::FiberArray& fibers,
                               fiber::QueryOptions options = {}) {
  const fiber::FiberAssembly assembly = to_assembly(fibers);
  options.margin = message.margin;
  fiber::QueryResult expected = fiber::test::brute_force(assembly, options);
  ASSERT_EQ(message.contacts.size(), expected.contacts.size());
  for (std::size_t i = 0; i < expected.contacts.size(); ++i) {
    expect_same(message.contacts[i], expected.contacts[i]);
  }
  options.type = fiber::QueryType::CLOSEST;
  options.margin = std::numeric_limits<double>::infinity();
  expected = fiber::test::brute_force(assembly, options);
  ASSERT_EQ(message.has_minimum, !expected.contacts.empty());
  if (message.has_minimum) {
    EXPECT_EQ(message.minimum_distance, expected.contacts.front().distance);
    expect_same(message.minimum, expected.contacts.front());
    EXPECT_LE(message.minimum_lower, expected.contacts.front().upper);
    EXPECT_GE(message.minimum_upper, expected.contacts.front().lower);
    double largest = 0.0;  // [m] coordinate
    for (const Eigen::Vector3d& point : assembly.points()) {
      largest = std::max(largest, point.cwiseAbs().maxCoeff());
    }
    const double reach = message.minimum_upper - message.minimum_lower;
    if (message.complete) {
      EXPECT_LT(reach, std::max(1e-9, 1e-14 * largest));
    } else {
      EXPECT_EQ(reach, std::numeric_limits<double>::infinity()) << "what is unknown may be nearer";
    }
  }
  EXPECT_EQ(message.complete != 0, message.unknown.empty());
}

}  // namespace node_test

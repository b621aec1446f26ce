#pragma once

#include <ros/node_handle.h>

#include <string>
#include <vector>

#include "fiber_proximity/ContactArray.h"
#include "fiber_proximity/query/options.hpp"
#include "src/query/touch_tracker.hpp"
#include "src/ros/detection/detector.hpp"
#include "src/ros/detection/knowledge.hpp"
#include "src/ros/detection/step_contacts.hpp"
#include "src/ros/outputs/output_topic.hpp"

namespace fiber_proximity_ros {

/// Names of the bodies that contacts are of, by index.
struct BodyNames {
  std::vector<std::string> a;
  std::vector<std::string> b;  ///< of objects; empty for fibres with each other
};

/// An answer whose contacts are published. Holds references: only for the call.
struct ContactAnswer {
  const Detection& detection;
  const fiber::QueryOptions& options;
  const KnownMotion* motion;  ///< since the answer before; null if it is of its stamp alone
  const Knowledge& knowledge;
  const BodyNames& names;
  const std_msgs::Header& header;
  const fiber::FiberAssembly& fibers;  ///< that the contacts are of
};

/// Publishes contacts of one kind, of fibres with each other or with objects: those of each answer,
/// and, on ~contact_events, that some began or ended. Contacts are recognised from answer to answer
/// by the names of their bodies.
class ContactOutput {
 public:
  /// @param topic       of ContactArray
  /// @param type_b      what the second bodies are, fiber_proximity::Contact::FIBER or OBJECT
  /// @param on_newcomer called when somebody begins to listen
  ContactOutput(ros::NodeHandle private_node, const std::string& topic, std::uint8_t type_b,
                const Newcomer& on_newcomer);

  bool has_listeners() const {
    return topic_.has_listeners() || event_publisher_.getNumSubscribers() > 0;
  }

  /// Takes the contacts of an answer; publishes what began and ended, if somebody listens.
  void track(const ContactAnswer& answer);

  /// Contacts of the answer that was tracked last.
  const std::vector<StepContact>& contacts() const { return contacts_; }

  /// Publishes them, if somebody listens.
  /// @param has_gradients whether derivatives are asked for
  /// @param update_time   [s]
  void publish(const ContactAnswer& answer, bool has_gradients, double update_time);

  /// An answer is not looked at: what is known of touches does not hold any more.
  void skip();

 private:
  Completeness completeness_of(const ContactAnswer& answer) const;
  void rename(const BodyNames& names, const fiber::TimeBounds& step);
  void publish_events(const BodyNames& names, const ContactAnswer& answer);

  std::uint8_t type_b_;
  OutputTopic<fiber_proximity::ContactArray> topic_;
  ros::Publisher event_publisher_;
  fiber::TouchTracker tracker_;
  bool has_answer_ = false;
  std::chrono::nanoseconds last_answer_{};
  BodyNames names_;  // of the last answer
  std::vector<StepContact> contacts_;
  // Members for their memory.
  std::vector<fiber::TouchingPair> pairs_;
  std::vector<fiber::TouchEvent> events_;
};

}  // namespace fiber_proximity_ros

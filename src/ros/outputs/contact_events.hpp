#pragma once

#include <ros/node_handle.h>

#include <string>
#include <vector>

#include "fiber_proximity/ContactEvent.h"
#include "src/query/touch_tracker.hpp"
#include "src/ros/outputs/step_contacts.hpp"

namespace fiber_proximity_ros {

/// Names of the bodies that contacts are of, by index.
struct BodyNames {
  std::vector<std::string> a;
  std::vector<std::string> b;
};

/// ~contact_events. Several of this node's publishers of it are one.
ros::Publisher advertise_contact_events(ros::NodeHandle& private_node);

/// Recognises contacts of one kind, of fibres with each other or with objects, from answer to
/// answer, by the names of their bodies, and tells of those that began or ended.
class ContactEvents {
 public:
  /// @param type_b    what the second bodies are, fiber_proximity::Contact::FIBER or OBJECT
  /// @param publisher of ContactEvent
  ContactEvents(std::uint8_t type_b, const ros::Publisher& publisher);

  bool has_listeners() const { return publisher_.getNumSubscribers() > 0; }

  /// Where a step begins that contacts may have come in since the answer before: its stamp, or this
  /// one if there is none, or time went back.
  fiber::TimeBounds step_to(std::chrono::nanoseconds now) const;

  /// Takes the contacts of an answer; publishes what began and ended, if somebody listens.
  void track(const std::vector<StepContact>& contacts, const BodyNames& names,
             const std_msgs::Header& header);

  /// The touch that a contact of the last answer belongs to.
  const fiber::Touch& touch_of(std::size_t contact) const { return tracker_.touch_of(contact); }

  /// An answer is not looked at: what is known of touches does not hold any more.
  void skip();

 private:
  void rename(const BodyNames& names, const fiber::TimeBounds& step);
  void publish(const BodyNames& names, const std_msgs::Header& header);

  std::uint8_t type_b_;
  ros::Publisher publisher_;
  fiber::TouchTracker tracker_;
  bool has_answer_ = false;
  std::chrono::nanoseconds last_answer_{};
  BodyNames names_;                         // of the last answer
  std::vector<fiber::TouchingPair> pairs_;  // a member for its memory
  std::vector<fiber::TouchEvent> events_;   // the same
};

}  // namespace fiber_proximity_ros

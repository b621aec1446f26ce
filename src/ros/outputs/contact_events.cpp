#include "src/ros/outputs/contact_events.hpp"

#include <algorithm>
#include <map>

#include "fiber_proximity/Contact.h"
#include "src/ros/outputs/fiber_step.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber_proximity::Contact;
using std::chrono::nanoseconds;

/// Where the bodies of these names are among others; of names that are there twice, the first.
fiber::TouchTracker::FiberIndices indices_among(const std::vector<std::string>& names,
                                                const std::vector<std::string>& others) {
  std::map<std::string_view, std::uint32_t> indices;
  for (std::uint32_t i = 0; i < others.size(); ++i) {
    indices.emplace(others[i], i);
  }
  fiber::TouchTracker::FiberIndices found;
  for (const std::string& name : names) {
    const auto index = indices.find(name);
    found.push_back(index == indices.end() ? std::nullopt : std::optional(index->second));
  }
  return found;
}

fiber::TouchingPair pair_of(const StepContact& contact, bool is_of_object) {
  const fiber::Contact& pair = contact.contact;
  // The shapes of an object are one body.
  return {pair.fiber_a,  pair.segment_a,
          pair.fiber_b,  is_of_object ? 0 : pair.segment_b,
          pair.distance, contact.state != StepContact::State::THERE,
          contact.first, contact.last};
}

/// [s] Of what was there before anybody looked, since then.
double duration_of(const fiber::TouchEvent& event) {
  const fiber::TimeBounds& began = event.touch.began;
  const bool is_known = began.lower != nanoseconds(0);
  return std::chrono::duration<double>(event.time.upper - (is_known ? began.lower : began.upper))
      .count();
}

}  // namespace

ros::Publisher advertise_contact_events(ros::NodeHandle& private_node) {
  // Each event counts, and an answer may have many of them.
  constexpr std::uint32_t most_waiting = 100000;
  return private_node.advertise<fiber_proximity::ContactEvent>("contact_events", most_waiting);
}

ContactEvents::ContactEvents(std::uint8_t type_b, const ros::Publisher& publisher)
    : type_b_(type_b), publisher_(publisher), tracker_(type_b == Contact::OBJECT ? 2 : 1, 2) {}

fiber::TimeBounds ContactEvents::step_to(nanoseconds now) const {
  return {has_answer_ ? std::min(last_answer_, now) : nanoseconds(0), now};
}

void ContactEvents::track(const std::vector<StepContact>& contacts, const BodyNames& names,
                          const std_msgs::Header& header) {
  const nanoseconds now = to_time(header.stamp);
  const fiber::TimeBounds step = step_to(now);
  events_.clear();
  rename(names, step);
  publish(names_, header);
  names_ = names;
  pairs_.clear();
  for (const StepContact& contact : contacts) {
    pairs_.push_back(pair_of(contact, type_b_ == Contact::OBJECT));
  }
  events_.clear();
  tracker_.advance(pairs_, step, events_);
  publish(names, header);
  has_answer_ = true;
  last_answer_ = now;
}

void ContactEvents::skip() {
  tracker_.forget();
  has_answer_ = false;
}

/// Bodies may have other indices, or be gone.
void ContactEvents::rename(const BodyNames& names, const fiber::TimeBounds& step) {
  if (type_b_ != Contact::OBJECT) {
    if (names.a != names_.a) {
      tracker_.renumber(indices_among(names_.a, names.a), step, events_);
    }
  } else if (names.a != names_.a || names.b != names_.b) {
    tracker_.renumber(indices_among(names_.a, names.a), indices_among(names_.b, names.b), step,
                      events_);
  }
}

void ContactEvents::publish(const BodyNames& names, const std_msgs::Header& header) {
  if (!has_listeners()) {
    return;
  }
  const std::vector<std::string>& names_b = type_b_ == Contact::OBJECT ? names.b : names.a;
  for (const fiber::TouchEvent& event : events_) {
    fiber_proximity::ContactEvent message;
    const fiber::TouchingPair& pair = event.touch.pair;
    message.header = header;
    message.kind = event.kind == fiber::TouchEvent::Kind::BEGAN
                       ? fiber_proximity::ContactEvent::BEGAN
                       : fiber_proximity::ContactEvent::ENDED;
    message.id = event.touch.id;
    message.type_a = Contact::FIBER;
    message.body_a = names.a[pair.fiber_a];
    message.fiber_a = pair.fiber_a;
    message.segment_a = pair.segment_a;
    message.type_b = type_b_;
    message.body_b = names_b[pair.fiber_b];
    message.fiber_b = pair.fiber_b;
    message.segment_b = pair.segment_b;
    message.time_lower = to_stamp(event.time.lower);
    message.time_upper = to_stamp(event.time.upper);
    if (event.kind == fiber::TouchEvent::Kind::ENDED) {
      message.duration = duration_of(event);
    }
    message.deepest_gap = event.touch.deepest;
    publisher_.publish(message);
  }
}

}  // namespace fiber_proximity_ros

#include "src/ros/outputs/contact_output.hpp"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <limits>
#include <map>
#include <optional>
#include <string_view>

#include "fiber_proximity/ContactEvent.h"
#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/support/stamps.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber_proximity::Contact;
using std::chrono::nanoseconds;

/// ~contact_events: each event counts, and an answer may have many of them.
constexpr std::uint32_t max_waiting_events = 100000;

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

void fill_pair(const StepContact& contact, bool is_of_object, fiber::TouchingPair& pair) {
  const fiber::Contact& from = contact.contact;
  pair.fiber_a = from.fiber_a;
  pair.segment_a = from.segment_a;
  pair.fiber_b = from.fiber_b;
  pair.segment_b = is_of_object ? 0 : from.segment_b;  // the shapes of an object are one body
  pair.distance = from.distance;
  pair.is_gone = contact.state != StepContact::State::THERE;
  pair.first = contact.first;
  pair.last = contact.last;
}

/// [s] Of what was there before anybody looked, since then.
double duration_of(const fiber::TouchEvent& event) {
  const fiber::TimeBounds& began = event.touch.began;
  const bool is_known = began.lower != nanoseconds(0);
  return std::chrono::duration<double>(event.time.upper - (is_known ? began.lower : began.upper))
      .count();
}

/// @param message with the names of the bodies
std::uint8_t kind_of(const fiber::TouchEvent& event, const fiber_proximity::ContactEvent& message,
                     const Knowledge& knowledge) {
  if (event.kind == fiber::TouchEvent::Kind::BEGAN) {
    return fiber_proximity::ContactEvent::BEGAN;
  }
  const bool is_lost = !knowledge.is_all_known() &&
                       (knowledge.is_lost(message.body_a) || knowledge.is_lost(message.body_b));
  return is_lost ? fiber_proximity::ContactEvent::LOST : fiber_proximity::ContactEvent::ENDED;
}

/// Where the fibres are closed.
fiber::TouchSeams seams_of(const fiber::FiberAssembly& fibers, std::uint8_t type_b) {
  fiber::TouchSeams seams;
  seams.are_of_both = type_b == Contact::FIBER;
  for (std::size_t i = 0; fibers.graph() != nullptr && i < fibers.fiber_count(); ++i) {
    seams.last_segments.push_back(
        fibers.is_closed(i) ? fibers.offsets()[i + 1] - fibers.offsets()[i] - 2 : 0);
  }
  return seams;
}

/// The time that an answer covers. Most times of its contacts are its ends.
struct AnswerTime {
  AnswerTime(nanoseconds since_time, nanoseconds now_time)
      : since(since_time),
        now(now_time),
        since_stamp(to_stamp(since_time)),
        now_stamp(to_stamp(now_time)) {}

  ros::Time stamp_of(nanoseconds time) const {
    return time == now ? now_stamp : time == since ? since_stamp : to_stamp(time);
  }

  const nanoseconds since;
  const nanoseconds now;
  const ros::Time since_stamp;
  const ros::Time now_stamp;
};

/// Adds what is known of it over time.
void add_details(const StepContact& contact, const fiber::Touch& touch, const AnswerTime& time,
                 Contact& message) {
  message.id = touch.id;
  message.age =
      std::chrono::duration<double>(std::max(time.now - touch.began.upper, nanoseconds(0))).count();
  message.time_lower = time.stamp_of(std::max(contact.first.lower, time.since));
  message.time_upper = time.stamp_of(contact.first.upper);
  message.gone = contact.state != StepContact::State::THERE;
  message.certain = message.gone ? contact.was_certain : message.certain;
}

}  // namespace

ContactOutput::ContactOutput(ros::NodeHandle private_node, const std::string& topic,
                             std::uint8_t type_b, const Newcomer& on_newcomer)
    : type_b_(type_b),
      topic_(private_node, topic, on_newcomer),
      event_publisher_(private_node.advertise<fiber_proximity::ContactEvent>("contact_events",
                                                                             max_waiting_events)),
      tracker_(type_b == Contact::OBJECT ? 2 : 1, 2) {}

void ContactOutput::track(const ContactAnswer& answer) {
  const nanoseconds now = to_time(answer.header.stamp);
  // From the answer before, or this one if there is none, or time went back.
  const fiber::TimeBounds step{has_answer_ ? std::min(last_answer_, now) : nanoseconds(0), now};
  step_contacts(answer.detection.contacts().contacts, step, answer.motion, contacts_);
  events_.clear();
  rename(answer.names, step);
  publish_events(names_, answer);
  names_ = answer.names;
  pairs_.resize(contacts_.size());
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    fill_pair(contacts_[i], type_b_ == Contact::OBJECT, pairs_[i]);
  }
  events_.clear();
  tracker_.set_seams(seams_of(answer.fibers, type_b_));
  tracker_.advance(pairs_, step, events_);
  publish_events(names_, answer);
  has_answer_ = true;
  last_answer_ = now;
}

void ContactOutput::publish(const ContactAnswer& answer, bool has_gradients, double update_time) {
  if (!topic_.has_listeners()) {
    return;
  }
  const auto& [detection, options, motion, knowledge, names, header, fibers] = answer;
  const Completeness completeness = completeness_of(answer);
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const nanoseconds now = to_time(header.stamp);
  const AnswerTime time(motion != nullptr ? motion->time.lower : now, now);
  const auto fill_in = [&, type_b = type_b_, margin = options.margin](const fiber::Contact& contact,
                                                                      Contact& filled) {
    to_message(contact, Contact::FIBER, type_b, filled);
    filled.certain = is_certain(contact, margin);
    filled.gradients.clear();  // of an earlier message
    if (has_gradients) {
      add_gradients(filled);
    }
  };
  fiber_proximity::ContactArray& message = topic_.message();
  message.header = header;
  message.fiber_names = names.a;
  message.object_names = names.b;
  message.continuous = motion != nullptr;
  message.since = time.since_stamp;
  message.contacts.resize(contacts_.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    if (contacts_[i].state != StepContact::State::LEFT) {
      Contact& contact = message.contacts[count++];
      fill_in(contacts_[i].contact, contact);
      add_details(contacts_[i], tracker_.touch_of(i), time, contact);
    }
  }
  message.contacts.resize(count);
  message.margin = options.margin;
  message.has_minimum = detection.minimum() != nullptr;
  message.minimum_distance = infinity;
  message.minimum = Contact();
  if (message.has_minimum) {
    message.minimum_distance = detection.minimum()->distance;
    fill_in(*detection.minimum(), message.minimum);
  }
  message.minimum_lower = completeness.lower(detection.minimum_lower(), -infinity);
  message.minimum_upper = detection.minimum_upper();
  message.kernel = name_of(options.kernel);
  message.tolerance = options.tolerance;
  message.complete = completeness.is_complete();
  message.unknown = completeness.unknown();
  message.limit_reached =
      detection.is_limit_reached() || (motion != nullptr && motion->result.limit_reached);
  message.node_tests = detection.counts().node_tests;
  message.node_overlaps = detection.counts().node_overlaps;
  message.primitive_tests = detection.counts().primitive_tests;
  message.update_time = update_time;
  message.detect_time = detection.contact_time() + detection.minimum_time();
  topic_.publish();
}

Completeness ContactOutput::completeness_of(const ContactAnswer& answer) const {
  using About = Knowledge::About;
  Completeness known = answer.knowledge.completeness(
      type_b_ == Contact::OBJECT ? About::FIBERS_AND_ENVIRONMENT : About::FIBERS);
  known.add_cut_off(answer.detection.cut_off(answer.options));
  if (answer.motion != nullptr && !answer.motion->result.complete) {
    known.add_cut_off(cut_off_text("pairs that move", answer.options));
  }
  return known;
}

void ContactOutput::skip() {
  tracker_.forget();
  has_answer_ = false;
}

/// Bodies may have other indices, or be gone.
void ContactOutput::rename(const BodyNames& names, const fiber::TimeBounds& step) {
  if (names.a == names_.a && names.b == names_.b) {
    return;
  }
  const auto indices_a = indices_among(names_.a, names.a);
  if (type_b_ == Contact::OBJECT) {
    tracker_.renumber(indices_a, indices_among(names_.b, names.b), step, events_);
  } else {
    tracker_.renumber(indices_a, step, events_);
  }
}

/// @param names of the answer that the events' indices are of
void ContactOutput::publish_events(const BodyNames& names, const ContactAnswer& answer) {
  if (event_publisher_.getNumSubscribers() == 0) {
    return;
  }
  const std::vector<std::string>& names_b = type_b_ == Contact::OBJECT ? names.b : names.a;
  for (const fiber::TouchEvent& event : events_) {
    const auto event_message = boost::make_shared<fiber_proximity::ContactEvent>();
    fiber_proximity::ContactEvent& message = *event_message;
    const fiber::TouchingPair& pair = event.touch.pair;
    message.header = answer.header;
    message.id = event.touch.id;
    message.type_a = Contact::FIBER;
    message.body_a = names.a[pair.fiber_a];
    message.fiber_a = pair.fiber_a;
    message.segment_a = pair.segment_a;
    message.type_b = type_b_;
    message.body_b = names_b[pair.fiber_b];
    message.kind = kind_of(event, message, answer.knowledge);
    message.fiber_b = pair.fiber_b;
    message.segment_b = pair.segment_b;
    message.time_lower = to_stamp(event.time.lower);
    message.time_upper = to_stamp(event.time.upper);
    if (event.kind == fiber::TouchEvent::Kind::ENDED) {
      message.duration = duration_of(event);
    }
    message.deepest_gap = event.touch.deepest;
    event_publisher_.publish(event_message);
  }
}

}  // namespace fiber_proximity_ros

#include "src/ros/outputs/step_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace fiber_proximity_ros {
namespace {

using fiber::MotionContact;
using fiber::TimeBounds;
using std::chrono::nanoseconds;

constexpr auto by_key = [](const auto& x, const auto& y) { return x.key() < y.key(); };

/// The times of parts of a motion, rounded outwards.
TimeBounds times_of(double lower, double upper, const TimeBounds& motion) {
  const auto length = static_cast<double>((motion.upper - motion.lower).count());
  const auto after_begin = [&](double count) {
    return motion.lower + nanoseconds(static_cast<std::int64_t>(count));
  };
  return {after_begin(std::floor(lower * length)),
          after_begin(std::ceil(std::min(upper, 1.0) * length))};
}

const MotionContact* find(const std::vector<MotionContact>& contacts,
                          const fiber::Contact& contact) {
  const auto found = std::lower_bound(contacts.begin(), contacts.end(), contact, by_key);
  return found != contacts.end() && found->key() == contact.key() ? &*found : nullptr;
}

}  // namespace

void StepContacts::assign(const std::vector<fiber::Contact>& now, const TimeBounds& step,
                          const KnownMotion* motion) {
  contacts_.clear();
  for (const fiber::Contact& contact : now) {
    contacts_.push_back({StepContact::State::THERE, contact, step, {}});
  }
  if (motion == nullptr) {
    return;
  }
  for (StepContact& there : contacts_) {
    if (const MotionContact* const began = find(motion->result.contacts, there.contact)) {
      there.first = times_of(began->lower, began->upper, motion->time);
    } else if (find(motion->result.touching, there.contact) != nullptr) {
      there.first = {motion->time.lower, motion->time.lower};
    }
  }
  gone_.clear();
  add_what_is_gone(motion->result.contacts, StepContact::State::PASSED, *motion);
  add_what_is_gone(motion->result.touching, StepContact::State::LEFT, *motion);
  contacts_.insert(contacts_.end(), gone_.begin(), gone_.end());
  std::sort(contacts_.begin(), contacts_.end(), [](const StepContact& x, const StepContact& y) {
    return by_key(x.contact, y.contact);
  });
}

void StepContacts::add_what_is_gone(const std::vector<MotionContact>& found,
                                    StepContact::State state, const KnownMotion& motion) {
  for (const MotionContact& contact : found) {
    const auto there = std::lower_bound(
        contacts_.begin(), contacts_.end(), contact,
        [](const StepContact& x, const MotionContact& y) { return x.contact.key() < y.key(); });
    if (there != contacts_.end() && there->contact.key() == contact.key()) {
      continue;
    }
    const fiber::LastContact last = motion.last_contact(contact);
    if (motion.reports_all || !last.lasts) {
      gone_.push_back({state, motion.first_contact(contact),
                       times_of(contact.lower, contact.upper, motion.time),
                       times_of(last.lower, last.upper, motion.time)});
    }
  }
}

void PassedContacts::add(const std::vector<StepContact>& contacts) {
  forget_old();
  const auto now = std::chrono::steady_clock::now();
  for (const StepContact& contact : contacts) {
    if (contact.state == StepContact::State::PASSED && contacts_.size() < most) {
      contacts_.push_back(contact.contact);
      arrivals_.push_back(now);
    }
  }
}

void PassedContacts::forget_old() {
  const auto now = std::chrono::steady_clock::now();
  const auto first_left =
      std::find_if(arrivals_.begin(), arrivals_.end(), [now](const auto& arrival) {
        return now - arrival < std::chrono::duration<double>(shown_for);
      });
  const auto gone = first_left - arrivals_.begin();
  arrivals_.erase(arrivals_.begin(), first_left);
  contacts_.erase(contacts_.begin(), contacts_.begin() + gone);
}

}  // namespace fiber_proximity_ros

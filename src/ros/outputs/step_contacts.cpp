#include "src/ros/outputs/step_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace fiber_proximity_ros {
namespace {

using fiber::MotionContact;
using fiber::TimeBounds;
using std::chrono::nanoseconds;

/// The times of parts of a motion, rounded outwards.
TimeBounds times_of(double lower, double upper, const TimeBounds& motion) {
  const auto length = static_cast<double>((motion.upper - motion.lower).count());
  const auto after_begin = [&](double count) {
    return motion.lower + nanoseconds(static_cast<std::int64_t>(count));
  };
  return {after_begin(std::floor(lower * length)),
          after_begin(std::ceil(std::min(upper, 1.0) * length))};
}

/// Finds one pair after the other, in their order, in a list that is sorted by key.
template <class Item>
class SortedList {
 public:
  /// @param items must outlive this
  explicit SortedList(const std::vector<Item>& items) : next_(items.begin()), end_(items.end()) {}

  /// @param key not less than in the call before
  /// @returns nullptr if it is not there
  template <class Key>
  const Item* find(const Key& key) {
    next_ = std::find_if(next_, end_, [&key](const Item& item) { return !(item.key() < key); });
    return next_ != end_ && next_->key() == key ? &*next_ : nullptr;
  }

 private:
  typename std::vector<Item>::const_iterator next_;
  typename std::vector<Item>::const_iterator end_;
};

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
  SortedList began_in_step(motion->result.contacts);
  SortedList there_before(motion->result.touching);
  for (StepContact& there : contacts_) {
    if (const MotionContact* const began = began_in_step.find(there.key())) {
      there.first = times_of(began->lower, began->upper, motion->time);
    } else if (there_before.find(there.key()) != nullptr) {
      there.first = {motion->time.lower, motion->time.lower};
    }
  }
  find_what_is_gone(now, motion->result.contacts, StepContact::State::PASSED, *motion);
  merge_gone();
  find_what_is_gone(now, motion->result.touching, StepContact::State::LEFT, *motion);
  merge_gone();
}

void StepContacts::find_what_is_gone(const std::vector<fiber::Contact>& now,
                                     const std::vector<MotionContact>& found,
                                     StepContact::State state, const KnownMotion& motion) {
  SortedList there_now(now);
  not_there_.clear();
  for (const MotionContact& contact : found) {
    if (there_now.find(contact.key()) == nullptr) {
      not_there_.push_back(contact);
    }
  }
  const std::vector<fiber::LastContact> last = motion.last_contacts(not_there_);
  for (std::size_t i = 0; i < not_there_.size(); ++i) {
    if (motion.reports_all || !last[i].lasts) {
      gone_.push_back({state, motion.first_contact(not_there_[i]),
                       times_of(not_there_[i].lower, not_there_[i].upper, motion.time),
                       times_of(last[i].lower, last[i].upper, motion.time)});
    }
  }
}

/// Moves what is gone to its places among the contacts.
void StepContacts::merge_gone() {
  const auto middle = static_cast<std::ptrdiff_t>(contacts_.size());
  contacts_.insert(contacts_.end(), gone_.begin(), gone_.end());
  std::inplace_merge(contacts_.begin(), contacts_.begin() + middle, contacts_.end(),
                     [](const StepContact& x, const StepContact& y) { return x.key() < y.key(); });
  gone_.clear();
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

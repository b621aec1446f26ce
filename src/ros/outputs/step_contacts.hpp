#pragma once

#include <chrono>
#include <functional>
#include <vector>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "src/query/touch_tracker.hpp"

namespace fiber_proximity_ros {

/// A contact during the step from the answer before to this one.
struct StepContact {
  enum class State {
    THERE,   ///< it is there now
    PASSED,  ///< it came and went in the step; distance and points are of when it came
    LEFT     ///< it was there before the step and is gone: the answer before has reported it
  };
  State state = State::THERE;
  fiber::Contact contact;
  fiber::TimeBounds first;  ///< when in the step it first was there
  fiber::TimeBounds last;   ///< unless it is there now: when it was for the last time

  auto key() const { return contact.key(); }
};

/// What is known of a motion.
struct KnownMotion {
  const fiber::MotionResult& result;
  std::function<fiber::Contact(const fiber::MotionContact&)> first_contact;
  std::function<std::vector<fiber::LastContact>(const std::vector<fiber::MotionContact>&)>
      last_contacts;
  fiber::TimeBounds time;  ///< from its begin to its end
  /// Whether all contacts there are now were asked for and found, so that others are gone. If not,
  /// only those are that have parted.
  bool reports_all = true;
};

/// All contacts of a step, in the order of Contact::key().
class StepContacts {
 public:
  /// @param now  contacts after the step
  /// @param step from the answer before to this one, within which a contact came
  /// @param motion of the step, if it is known: it tells when, and what was gone again by now
  void assign(const std::vector<fiber::Contact>& now, const fiber::TimeBounds& step,
              const KnownMotion* motion);

  const std::vector<StepContact>& contacts() const { return contacts_; }

 private:
  void find_what_is_gone(const std::vector<fiber::Contact>& now,
                         const std::vector<fiber::MotionContact>& found, StepContact::State state,
                         const KnownMotion& motion);
  void merge_gone();

  std::vector<StepContact> contacts_;
  // Members for their memory.
  std::vector<fiber::MotionContact> not_there_;  // of the motion, but not at its end
  std::vector<StepContact> gone_;
};

/// Contacts that came and went, kept for a moment so that somebody can see them.
class PassedContacts {
 public:
  static constexpr double shown_for = 1.0;    ///< [s] of wall time
  static constexpr std::size_t most = 10000;  ///< more cannot be told apart

  void add(const std::vector<StepContact>& contacts);
  void forget_old();
  const std::vector<fiber::Contact>& contacts() const { return contacts_; }

 private:
  std::vector<fiber::Contact> contacts_;
  std::vector<std::chrono::steady_clock::time_point> arrivals_;  // of each, in their order
};

}  // namespace fiber_proximity_ros

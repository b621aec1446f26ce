#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <vector>

#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "src/query/touch_tracker.hpp"
#include "src/ros/detection/budget.hpp"

namespace fiber_proximity_ros {

/// A step of the fibres, from one answer to the next, that is to be looked at as a motion.
struct ContinuousStep {
  fiber::FiberMotion motion;
  fiber::TimeBounds time;
  double tolerance;  ///< [m] see fiber::MotionOptions
  /// [m] By fibre, see Uncertainty; empty where none is uncertain.
  std::vector<double> uncertainties;
};

/// The result of a query about a motion.
///
/// Where fibres are uncertain, it is about true points that move linearly, and are within the
/// uncertainty of the told ones at both ends. The contacts are then the possible ones: there is
/// none before `lower`, and the certain ones are there by `upper`. Others may also come later, or
/// not at all; their `upper` is when the told points are nearest to a contact first.
struct KnownMotion {
  const fiber::MotionResult& result;
  std::function<fiber::Contact(const fiber::MotionContact&)> first_contact;
  std::function<std::vector<fiber::LastContact>(const std::vector<fiber::MotionContact>&)>
      last_contacts;
  fiber::TimeBounds time;  ///< from its begin to its end
  /// Whether all contacts there are now were asked for and found, so that others are gone. If not,
  /// only those are that have parted.
  bool reports_all = true;
  bool is_uncertain = false;  ///< whether fibres are
};

/// Finds what of the fibres came into contact with each other in a step. They must live, unchanged,
/// as long as what is found is used.
/// @param engine      that is there for motions
/// @param options     of the query whose contacts there are now
/// @param reports_all see KnownMotion
/// @param result      what is found refers to it
/// @param budget      of the answer, in whose current stage this is done
/// @throws std::invalid_argument for fibres that move too far, or that the engine cannot take
KnownMotion detect_motion_contacts(fiber::ProximityEngine& engine, const ContinuousStep& step,
                                   const fiber::QueryOptions& options, bool reports_all,
                                   fiber::MotionResult& result, Budget& budget);

/// The environment before a step and after it.
struct MovingEnvironment {
  std::shared_ptr<const fiber::Environment> before;
  std::shared_ptr<const fiber::Environment> now;
};

/// Finds what of the fibres came into contact with objects in a step. Objects move from where they
/// were to where they are; those that were not there before, or had other shapes, as a point cloud
/// does, count as standing still.
/// @throws std::invalid_argument as fiber::Environment::query_motion()
KnownMotion detect_motion_contacts(const MovingEnvironment& environment,
                                   const fiber::AllowedPairs& allowed, const ContinuousStep& step,
                                   const fiber::QueryOptions& options, bool reports_all,
                                   fiber::MotionResult& result, Budget& budget);

/// A contact during the step from the answer before to this one.
struct StepContact {
  enum class State {
    THERE,   ///< it is there now
    PASSED,  ///< it came and went in the step; distance and points are of when it came
    LEFT     ///< it was there before the step and is gone: the answer before has reported it
  };
  State state = State::THERE;
  fiber::Contact contact;
  fiber::TimeBounds first;   ///< when in the step it first was there, if it was at all
  fiber::TimeBounds last;    ///< unless it is there now: when it was for the last time
  bool was_certain = false;  ///< unless it is there now: whether it was there at all

  auto key() const { return contact.key(); }
};

/// Finds all contacts of a step, in the order of Contact::key().
/// @param now  contacts after the step
/// @param step from the answer before to this one, within which a contact came
/// @param motion of the step, if it is known: it tells when, and what was gone again by now
void step_contacts(const std::vector<fiber::Contact>& now, const fiber::TimeBounds& step,
                   const KnownMotion* motion, std::vector<StepContact>& contacts);

/// Contacts that came and went, kept for a moment so that somebody can see them.
class PassedContacts {
 public:
  static constexpr double shown_for = 1.0;         ///< [s] of wall time
  static constexpr std::size_t max_count = 10000;  ///< more cannot be told apart

  void add(const std::vector<StepContact>& contacts);
  void forget_old();
  const std::vector<fiber::Contact>& contacts() const { return contacts_; }

 private:
  std::vector<fiber::Contact> contacts_;
  std::vector<std::chrono::steady_clock::time_point> arrivals_;  // of each, in their order
};

}  // namespace fiber_proximity_ros

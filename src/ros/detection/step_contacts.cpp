#include "src/ros/detection/step_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "src/query/motion_evaluator.hpp"
#include "src/ros/detection/uncertainty.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber::Environment;
using fiber::EnvironmentObject;
using fiber::MotionContact;
using fiber::MotionOptions;
using fiber::TimeBounds;
using std::chrono::nanoseconds;

/// One contact for each pair of fibres, as the query has it.
void keep_earliest_of_fiber_pairs(std::vector<MotionContact>& contacts) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, MotionContact> earliest;
  for (const MotionContact& contact : contacts) {
    MotionContact& first =
        earliest.try_emplace({contact.fiber_a, contact.fiber_b}, contact).first->second;
    if (contact.earlier_than(first)) {
      first = contact;
    }
  }
  contacts.clear();
  for (const auto& [fibers, contact] : earliest) {
    contacts.push_back(contact);
  }
}

/// @param sorted by key
/// @returns nullptr if the pair is not among them
template <class Item, class Key>
const Item* find_pair(const std::vector<Item>& sorted, const Key& key) {
  const auto found =
      std::lower_bound(sorted.begin(), sorted.end(), key,
                       [](const Item& item, const Key& other) { return item.key() < other; });
  return found != sorted.end() && found->key() == key ? &*found : nullptr;
}

/// When a pair first comes within a margin.
fiber::ContactTime time_within(const fiber::FiberMotion& motion, const MotionContact& pair,
                               double margin, double tolerance) {
  const std::vector<std::uint32_t>& offsets = motion.before.offsets();
  const fiber::PointPair points{offsets[pair.fiber_a] + pair.segment_a,
                                offsets[pair.fiber_b] + pair.segment_b};
  const fiber::SegmentMotions motions = fiber::motions_of(motion, motion, points, margin);
  if (motions.limit.radius_a + motions.limit.radius_b + margin < 0.0) {
    return {};
  }
  return fiber::contact_time(motions, tolerance);
}

/// Leaves, of pairs that come within the margin and the largest uncertainty of all, those that come
/// within their own, and tells by when which are certain to have come within the margin.
void judge_pairs(const fiber::FiberMotion& motion, const Uncertainty& uncertainty,
                 const MotionOptions& asked, fiber::MotionResult& result) {
  fiber::MotionSlice judged;
  for (const std::vector<MotionContact>* contacts : {&result.contacts, &result.touching}) {
    for (MotionContact contact : *contacts) {
      const fiber::ContactTime possible = time_within(
          motion, contact, uncertainty.possible_margin(asked.margin, contact), asked.tolerance);
      const fiber::ContactTime certain = time_within(
          motion, contact, uncertainty.certain_margin(asked.margin, contact), asked.tolerance);
      if (possible.hit) {
        contact.certain = certain.hit && certain.certain;
        contact.lower = possible.lower;
        contact.upper = contact.certain ? certain.upper : possible.upper;
        (fiber::is_there_before(possible) ? judged.touching : judged.contacts).push_back(contact);
      }
    }
  }
  std::sort(judged.contacts.begin(), judged.contacts.end(), fiber::by_key);
  std::sort(judged.touching.begin(), judged.touching.end(), fiber::by_key);
  const bool was_limited = result.limit_reached;
  fiber::MotionCandidates candidates;
  candidates.counts = result.counts;
  candidates.are_all = result.complete;
  result.contacts.clear();
  result.touching.clear();
  fiber::merge_slices(&judged, 1, candidates, asked, result);
  result.limit_reached = result.limit_reached || was_limited;
}

/// Tells of possible contacts by when they are certain.
/// @param certain of the told points and a smaller margin
void take_certain(const fiber::MotionResult& certain, fiber::MotionResult& possible) {
  for (std::vector<MotionContact>* contacts : {&possible.contacts, &possible.touching}) {
    for (MotionContact& contact : *contacts) {
      const MotionContact* found = find_pair(certain.touching, contact.key());
      found = found != nullptr ? found : find_pair(certain.contacts, contact.key());
      contact.certain = found != nullptr && found->certain;
      contact.upper = contact.certain ? found->upper : contact.upper;
    }
  }
}

/// When a possible contact was there for the last time.
/// @param told by the margin and its uncertainty
fiber::LastContact last_possible(const MotionContact& contact, fiber::LastContact told) {
  told.lower = contact.certain ? contact.upper : contact.lower;
  return told;
}

/// The objects there are now where they were before; those that cannot have moved from there, where
/// they are.
std::shared_ptr<const Environment> as_before(const MovingEnvironment& environment) {
  if (environment.before == environment.now) {
    return environment.now;
  }
  std::map<std::string_view, const EnvironmentObject*> by_name;
  for (const EnvironmentObject& object : environment.before->objects()) {
    by_name.emplace(object.name, &object);
  }
  std::vector<EnvironmentObject> objects = environment.now->objects();
  for (EnvironmentObject& object : objects) {
    const auto found = by_name.find(object.name);
    if (found != by_name.end() && fiber::have_same_shapes(*found->second, object)) {
      object.pose = found->second->pose;
    }
  }
  return std::make_shared<const Environment>(std::move(objects));
}

/// The times of parts of a motion, rounded outwards.
TimeBounds times_of(double lower, double upper, const TimeBounds& motion) {
  const auto length = static_cast<double>((motion.upper - motion.lower).count());
  const auto after_begin = [&](double count) {
    return motion.lower + nanoseconds(static_cast<std::int64_t>(count));
  };
  return {after_begin(std::floor(lower * length)),
          after_begin(std::ceil(std::min(upper, 1.0) * length))};
}

/// When a contact first was there.
/// @param latest part of the motion: after it there is none
TimeBounds first_time_of(const MotionContact& contact, double latest, const KnownMotion& motion) {
  const bool is_known = contact.certain || !motion.is_uncertain;
  return times_of(contact.lower, is_known ? contact.upper : latest, motion.time);
}

/// Adds what was found in a motion and is gone by now, in its places.
void add_what_is_gone(const std::vector<fiber::Contact>& now,
                      const std::vector<MotionContact>& found, StepContact::State state,
                      const KnownMotion& motion, std::vector<StepContact>& contacts) {
  std::vector<MotionContact> gone;
  std::copy_if(found.begin(), found.end(), std::back_inserter(gone),
               [&now](const MotionContact& each) { return find_pair(now, each.key()) == nullptr; });
  const std::vector<fiber::LastContact> last = motion.last_contacts(gone);
  const auto middle = static_cast<std::ptrdiff_t>(contacts.size());
  for (std::size_t i = 0; i < gone.size(); ++i) {
    if (motion.reports_all || !last[i].lasts) {
      contacts.push_back({state, motion.first_contact(gone[i]),
                          first_time_of(gone[i], last[i].upper, motion),
                          times_of(last[i].lower, last[i].upper, motion.time), gone[i].certain});
    }
  }
  std::inplace_merge(contacts.begin(), contacts.begin() + middle, contacts.end(),
                     [](const StepContact& x, const StepContact& y) { return x.key() < y.key(); });
}

}  // namespace

KnownMotion detect_motion_contacts(fiber::ProximityEngine& engine, const ContinuousStep& step,
                                   const fiber::QueryOptions& options, bool reports_all,
                                   fiber::MotionResult& result, Budget& budget) {
  const fiber::FiberMotion motion = step.motion;
  const MotionOptions asked = fiber::motion_options(options, step.tolerance);
  const Uncertainty uncertainty(step.uncertainties, Uncertainty::Bodies::BOTH);
  engine.update_motion(motion.before, motion.after);
  MotionOptions wide = asked;
  if (!uncertainty.is_none()) {
    wide.type = fiber::MotionType::ALL;  // those that come first may be impossible
    wide.margin = uncertainty.possible_margin(asked.margin);
  }
  budget.ask(wide, [&](const MotionOptions& in_time) { engine.query_motion(in_time, result); });
  if (!uncertainty.is_none()) {
    judge_pairs(motion, uncertainty, asked, result);
  }
  if (options.type == fiber::QueryType::FIBER_PAIRS) {
    keep_earliest_of_fiber_pairs(result.contacts);
  }
  return {result,
          [motion, uncertainty](const MotionContact& contact) {
            fiber::Contact first = fiber::first_contact(motion, motion, contact);
            uncertainty.widen(first);
            return first;
          },
          [motion, asked, uncertainty](const std::vector<MotionContact>& contacts) {
            if (uncertainty.is_none()) {
              return fiber::last_contacts(motion, motion, contacts, asked);
            }
            std::vector<fiber::LastContact> last;
            for (const MotionContact& contact : contacts) {
              MotionOptions possible = asked;
              possible.margin = uncertainty.possible_margin(asked.margin, contact);
              last.push_back(last_possible(
                  contact, fiber::last_contacts(motion, motion, {contact}, possible).front()));
            }
            return last;
          },
          step.time,
          reports_all,
          !uncertainty.is_none()};
}

KnownMotion detect_motion_contacts(const MovingEnvironment& environment,
                                   const fiber::AllowedPairs& allowed, const ContinuousStep& step,
                                   const fiber::QueryOptions& options, bool reports_all,
                                   fiber::MotionResult& result, Budget& budget) {
  const fiber::FiberMotion motion = step.motion;
  const MotionOptions asked = fiber::motion_options(options, step.tolerance);
  const Uncertainty uncertainty(step.uncertainties, Uncertainty::Bodies::A);
  const std::shared_ptr<const Environment> before = as_before(environment);
  const std::shared_ptr<const Environment> now = environment.now;
  const auto ask = [&](const fiber::FiberAssembly& from, const fiber::FiberAssembly& to,
                       const MotionOptions& about, fiber::MotionResult& found) {
    budget.ask(about, [&](const MotionOptions& in_time) {
      before->query_motion(from, to, *now, in_time, allowed, found);
    });
  };
  if (uncertainty.is_none()) {
    ask(motion.before, motion.after, asked, result);
  } else {
    ask(enclosing_fibers(motion.before, step.uncertainties),
        enclosing_fibers(motion.after, step.uncertainties), asked, result);
    fiber::MotionResult certain;
    MotionOptions narrow = asked;
    narrow.type = fiber::MotionType::ALL;
    narrow.margin = uncertainty.certain_margin(asked.margin);
    if (narrow.margin >= 0.0) {
      ask(motion.before, motion.after, narrow, certain);
    }
    take_certain(certain, result);
  }
  const auto first_contact = [=](const MotionContact& contact) {
    fiber::Contact first = before->first_contact(motion, *now, contact);
    uncertainty.widen(first);
    return first;
  };
  // Nothing is known of when it parted but whether it has.
  const auto last_contacts = [=](const std::vector<MotionContact>& contacts) {
    std::vector<fiber::LastContact> last;
    for (const MotionContact& contact : contacts) {
      const std::uint32_t point = motion.before.offsets()[contact.fiber_a] + contact.segment_a;
      const fiber::Contact at_end =
          now->contact(fiber::capsule_at(motion, point, 1.0), contact.fiber_b, contact.segment_b);
      const fiber::LastContact told{
          fiber::time_of(contact), 1.0,
          at_end.distance <= uncertainty.possible_margin(asked.margin, contact)};
      last.push_back(uncertainty.is_none() ? told : last_possible(contact, told));
    }
    return last;
  };
  return {result, first_contact, last_contacts, step.time, reports_all, !uncertainty.is_none()};
}

void step_contacts(const std::vector<fiber::Contact>& now, const TimeBounds& step,
                   const KnownMotion* motion, std::vector<StepContact>& contacts) {
  // Those of the answer before are written over: making them anew would take as long.
  contacts.resize(now.size());
  for (std::size_t i = 0; i < now.size(); ++i) {
    StepContact& there = contacts[i];
    there.state = StepContact::State::THERE;
    there.contact = now[i];
    there.first = step;
    there.last = TimeBounds();
    there.was_certain = false;
  }
  if (motion == nullptr) {
    return;
  }
  const std::vector<MotionContact>& began = motion->result.contacts;
  const std::vector<MotionContact>& touching = motion->result.touching;
  for (StepContact& there : contacts) {
    if (const MotionContact* const contact = find_pair(began, there.key())) {
      there.first = first_time_of(*contact, 1.0, *motion);
    } else if (const MotionContact* const before = find_pair(touching, there.key())) {
      there.first = first_time_of(*before, 1.0, *motion);
    }
  }
  add_what_is_gone(now, began, StepContact::State::PASSED, *motion, contacts);
  add_what_is_gone(now, touching, StepContact::State::LEFT, *motion, contacts);
}

void PassedContacts::add(const std::vector<StepContact>& contacts) {
  forget_old();
  const auto now = std::chrono::steady_clock::now();
  for (const StepContact& contact : contacts) {
    if (contact.state == StepContact::State::PASSED && contacts_.size() < max_count) {
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

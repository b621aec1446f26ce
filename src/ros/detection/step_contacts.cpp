#include "src/ros/detection/step_contacts.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>

namespace fiber_proximity_ros {
namespace {

using fiber::Environment;
using fiber::EnvironmentObject;
using fiber::MotionContact;
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

/// @param sorted by key
/// @returns nullptr if the pair is not among them
template <class Item, class Key>
const Item* find_pair(const std::vector<Item>& sorted, const Key& key) {
  const auto found =
      std::lower_bound(sorted.begin(), sorted.end(), key,
                       [](const Item& item, const Key& other) { return item.key() < other; });
  return found != sorted.end() && found->key() == key ? &*found : nullptr;
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
                          times_of(gone[i].lower, gone[i].upper, motion.time),
                          times_of(last[i].lower, last[i].upper, motion.time)});
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
  const fiber::MotionOptions asked = fiber::motion_options(options, step.tolerance);
  engine.update_motion(motion.before, motion.after);
  budget.ask(asked,
             [&](const fiber::MotionOptions& in_time) { engine.query_motion(in_time, result); });
  if (options.type == fiber::QueryType::FIBER_PAIRS) {
    keep_earliest_of_fiber_pairs(result.contacts);
  }
  return {result,
          [motion](const MotionContact& contact) {
            return fiber::first_contact(motion, motion, contact);
          },
          [motion, asked](const std::vector<MotionContact>& contacts) {
            return fiber::last_contacts(motion, motion, contacts, asked);
          },
          step.time, reports_all};
}

KnownMotion detect_motion_contacts(const MovingEnvironment& environment,
                                   const fiber::AllowedPairs& allowed, const ContinuousStep& step,
                                   const fiber::QueryOptions& options, bool reports_all,
                                   fiber::MotionResult& result, Budget& budget) {
  const fiber::FiberMotion motion = step.motion;
  const fiber::MotionOptions asked = fiber::motion_options(options, step.tolerance);
  const std::shared_ptr<const Environment> before = as_before(environment);
  const std::shared_ptr<const Environment> now = environment.now;
  budget.ask(asked, [&](const fiber::MotionOptions& in_time) {
    before->query_motion(motion.before, motion.after, *now, in_time, allowed, result);
  });
  const auto first_contact = [=](const MotionContact& contact) {
    return before->first_contact(motion, *now, contact);
  };
  // Nothing is known of when it parted but whether it has.
  const auto last_contacts = [=](const std::vector<MotionContact>& contacts) {
    std::vector<fiber::LastContact> last;
    for (const MotionContact& contact : contacts) {
      const std::uint32_t point = motion.before.offsets()[contact.fiber_a] + contact.segment_a;
      const fiber::Contact at_end =
          now->contact(fiber::capsule_at(motion, point, 1.0), contact.fiber_b, contact.segment_b);
      last.push_back({fiber::time_of(contact), 1.0, at_end.distance <= asked.margin});
    }
    return last;
  };
  return {result, first_contact, last_contacts, step.time, reports_all};
}

std::vector<StepContact> step_contacts(const std::vector<fiber::Contact>& now,
                                       const TimeBounds& step, const KnownMotion* motion) {
  std::vector<StepContact> contacts;
  for (const fiber::Contact& contact : now) {
    contacts.push_back({StepContact::State::THERE, contact, step, {}});
  }
  if (motion == nullptr) {
    return contacts;
  }
  const std::vector<MotionContact>& began = motion->result.contacts;
  const std::vector<MotionContact>& touching = motion->result.touching;
  for (StepContact& there : contacts) {
    if (const MotionContact* const contact = find_pair(began, there.key())) {
      there.first = times_of(contact->lower, contact->upper, motion->time);
    } else if (find_pair(touching, there.key()) != nullptr) {
      there.first = {motion->time.lower, motion->time.lower};
    }
  }
  add_what_is_gone(now, began, StepContact::State::PASSED, *motion, contacts);
  add_what_is_gone(now, touching, StepContact::State::LEFT, *motion, contacts);
  return contacts;
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

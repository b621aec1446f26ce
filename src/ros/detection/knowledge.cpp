#include "src/ros/detection/knowledge.hpp"

#include <ros/console.h>

#include <algorithm>
#include <utility>

namespace fiber_proximity_ros {
namespace {

/// An answer lists at most so many unknown things; of the others it says only how many there are.
constexpr std::size_t max_unknown = 20;

/// [s] of wall time something may be unknown without a word in the log: all is, for a moment, when
/// a node starts.
constexpr double quiet_time = 1.0;

/// Lines in the log at a time.
constexpr int max_lines = 10;

bool are_same(const std::vector<Unknown>& x, const std::vector<Unknown>& y) {
  return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                    [](const Unknown& a, const Unknown& b) { return a.what == b.what; });
}

}  // namespace

void Completeness::add(const std::vector<Unknown>& unknown) {
  was_all_there_ = was_all_there_ && unknown.empty();
  for (std::size_t i = 0; i < std::min(unknown.size(), max_unknown); ++i) {
    unknown_.push_back(text_of(unknown[i]));
  }
  if (unknown.size() > max_unknown) {
    unknown_.push_back("and " + std::to_string(unknown.size() - max_unknown) + " more");
  }
}

void Completeness::add_cut_off(const std::string& why) {
  if (!why.empty()) {
    unknown_.push_back(why);
  }
}

bool Knowledge::update() {
  std::vector<Unknown> fibers = fibers_.unknown();
  std::vector<Unknown> objects = environment_.unknown(true);
  const bool changed = !are_same(fibers, unknown_fibers_) || !are_same(objects, unknown_objects_);
  unknown_fibers_ = std::move(fibers);
  unknown_objects_ = std::move(objects);
  if (!is_all_known() || !noted_.empty()) {
    for (auto& [what, noted] : noted_) {
      noted.is_unknown = false;
    }
    note(unknown_fibers_);
    note(unknown_objects_);
    for (auto each = noted_.begin(); each != noted_.end();) {
      const auto& [what, noted] = *each;
      if (!noted.is_unknown && noted.is_logged) {
        ROS_INFO_STREAM(what << ": known again");
      }
      each = noted.is_unknown ? std::next(each) : noted_.erase(each);
    }
  }
  return changed;
}

void Knowledge::note(const std::vector<Unknown>& unknown) {
  const ros::SteadyTime now = ros::SteadyTime::now();
  int lines = 0;
  for (const Unknown& each : unknown) {
    if (each.is_logged) {
      continue;
    }
    Noted& noted = noted_[each.what];
    noted.is_unknown = true;
    if (!noted.is_logged && (now - noted.since).toSec() >= quiet_time && lines < max_lines) {
      noted.is_logged = true;
      ++lines;
      ROS_WARN_STREAM("answers are incomplete: " << text_of(each));
    }
  }
}

bool Knowledge::is_lost(const std::string& name) const {
  const auto is_of = [&name](const std::string& fiber) {
    // Where points are missing, what is left of a fibre may be pieces of it: NAME[i].
    return name.compare(0, fiber.size(), fiber) == 0 &&
           (name.size() == fiber.size() || name[fiber.size()] == '[');
  };
  for (const std::unique_ptr<Input>& input : fibers_.inputs()) {
    if ((input->unknown() || !input->is_fresh()) &&
        std::any_of(input->names().begin(), input->names().end(), is_of)) {
      return true;
    }
  }
  return std::any_of(unknown_objects_.begin(), unknown_objects_.end(),
                     [&name](const Unknown& object) { return object.what == name; });
}

Completeness Knowledge::completeness(About about, bool of_shapes) const {
  Completeness completeness;
  if (about != About::ENVIRONMENT) {
    completeness.add(unknown_fibers_);
  }
  if (about != About::FIBERS) {
    completeness.add(of_shapes ? environment_.unknown(false) : unknown_objects_);
  }
  return completeness;
}

}  // namespace fiber_proximity_ros

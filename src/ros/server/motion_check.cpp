#include "src/ros/server/motion_check.hpp"

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "fiber_proximity/environment/check_fibers.hpp"
#include "fiber_proximity/ros/conversions.hpp"
#include "src/geometry/swept_fibers.hpp"
#include "src/ros/inputs/fixed_frame.hpp"
#include "src/ros/server/request_options.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber_proximity::CheckFibers;
using fiber_proximity::Contact;

fiber::MotionOptions options_of_motions(const CheckFibers::Request& request,
                                        const fiber::QueryOptions& defaults) {
  constexpr double usual_tolerance = 1e-6;  // [m]
  fiber::QueryOptions options = to_options(request, defaults);
  if (options.type == fiber::QueryType::CLOSEST || options.type == fiber::QueryType::FIBER_PAIRS) {
    throw std::invalid_argument("type is " + std::to_string(request.type) +
                                ", of motions it must be 0 (FIRST), 2 (LIMITED) or 3 (ALL)");
  }
  const double tolerance = request.motion_tolerance;
  if (!(tolerance >= 0.0 && std::isfinite(tolerance))) {
    throw std::invalid_argument("motion_tolerance is " + std::to_string(tolerance) +
                                " m, it must be finite and at least 0");
  }
  options.neighbour_skip = defaults.neighbour_skip;
  options.neighbour_skip_length = defaults.neighbour_skip_length;
  fiber::validate(options);
  return fiber::motion_options(options, tolerance > 0.0 ? tolerance : usual_tolerance);
}

/// Which candidates are the states of which motion.
class Waypoints {
 public:
  explicit Waypoints(const CheckFibers::Request& request) : offsets_(request.waypoint_offsets) {
    const std::size_t count = request.candidates.size();
    if (offsets_.front() != 0) {
      refuse("begins with " + std::to_string(offsets_.front()) + ", it must begin with 0");
    }
    for (std::size_t i = 0; i + 1 < offsets_.size(); ++i) {
      if (offsets_[i + 1] < offsets_[i] + std::uint64_t{2}) {
        refuse("has " + std::to_string(offsets_[i + 1]) + " behind " + std::to_string(offsets_[i]) +
               ": motion " + std::to_string(i) + " needs at least 2 states");
      }
    }
    if (offsets_.back() != count) {
      refuse("ends with " + std::to_string(offsets_.back()) +
             ", it must end with the number of candidates, " + std::to_string(count));
    }
  }

  std::size_t motion_count() const { return offsets_.size() - 1; }
  std::size_t begin(std::size_t motion) const { return offsets_[motion]; }
  std::size_t end(std::size_t motion) const { return offsets_[motion + 1]; }

 private:
  [[noreturn]] static void refuse(const std::string& what) {
    throw std::invalid_argument("waypoint_offsets " + what);
  }

  const std::vector<std::uint32_t>& offsets_;
};

fiber::FiberPath read_motion(const CheckFibers::Request& request, const Waypoints& waypoints,
                             std::size_t motion, const QueryTarget& target) {
  fiber::FiberPath path;
  const std::size_t begin = waypoints.begin(motion);
  for (std::size_t i = begin; i < waypoints.end(motion); ++i) {
    const std::string where = "motion " + std::to_string(motion) + ", state " +
                              std::to_string(i - begin) + " (candidate " + std::to_string(i) + ")";
    naming(where, [&] {
      path.push_back(to_candidate(request.candidates[i], target.frame));
      fiber::require_same_topology(path.front(), path.back());
      if (request.candidates[i].names != request.candidates[begin].names) {
        throw std::invalid_argument("has other names than the motion's first state");
      }
    });
  }
  return path;
}

/// Motions that are checked at once: those of the same names in a row, which may touch the same,
/// and not so many that it takes long to see that a deadline has come.
class MotionBlock {
 public:
  static constexpr std::size_t most_states = 256;

  /// Reads the block that begins at this motion.
  MotionBlock(const CheckFibers::Request& request, const Waypoints& waypoints, std::size_t begin,
              const QueryTarget& target)
      : names_(request.candidates[waypoints.begin(begin)].names) {
    const auto is_next = [&](std::size_t motion) {
      return motion == begin ||
             (waypoints.end(motion) - waypoints.begin(begin) <= most_states &&
              request.candidates[waypoints.begin(motion)].names == names_ && !target.is_time_up());
    };
    for (std::size_t i = begin; i < waypoints.motion_count() && is_next(i); ++i) {
      motions_.push_back(read_motion(request, waypoints, i, target));
    }
  }

  const std::vector<std::string>& names() const { return names_; }
  const std::vector<fiber::FiberPath>& motions() const { return motions_; }

 private:
  const std::vector<std::string>& names_;
  std::vector<fiber::FiberPath> motions_;
};

void append(const fiber::PathContacts& found, std::uint8_t body_b,
            CheckFibers::Response& response) {
  for (const fiber::PathContact& contact : found.contacts) {
    Contact message;
    to_message(contact.where, Contact::CANDIDATE, body_b, message);
    response.contacts.push_back(message);
    response.time_lower.push_back(contact.when.lower);
    response.time_upper.push_back(contact.when.upper);
  }
}

void append(const fiber::MotionCheck& check, const PresentFibers& present,
            CheckFibers::Response& response) {
  response.free.push_back(check.is_free());
  response.complete.push_back(check.is_complete());
  response.limit_reached = response.limit_reached || check.is_limit_reached();
  append(check.self, Contact::CANDIDATE, response);
  const std::size_t first = response.contacts.size();
  append(check.fibers, Contact::FIBER, response);
  present.number_as_all(first, response);
  append(check.environment, Contact::OBJECT, response);
  response.offsets.push_back(static_cast<std::uint32_t>(response.contacts.size()));
}

}  // namespace

void answer_motions(const CheckFibers::Request& request, const QueryTarget& target,
                    const FindAllowed& find_allowed, CheckFibers::Response& response) {
  fiber::MotionOptions options = options_of_motions(request, target.defaults);
  const Waypoints waypoints(request);
  const PresentFibers present(target, request);
  fiber::Surroundings surroundings = present.surroundings();
  const std::size_t count = waypoints.motion_count();
  response.offsets.push_back(0);
  std::vector<fiber::MotionCheck> checks;
  while (response.free.size() < count && !target.is_time_up()) {
    const MotionBlock block(request, waypoints, response.free.size(), target);
    surroundings.allowed = find_allowed(block.names());
    options.deadline = target.time_for_query();
    options.contact_limit =
        share_of_contacts(target.defaults.contact_limit, response.contacts.size(),
                          queries_per_candidate * block.motions().size());
    check_motions(block.motions(), surroundings, options, checks);
    for (const fiber::MotionCheck& check : checks) {
      append(check, present, response);
    }
  }
  leave_unread(count, response);
}

}  // namespace fiber_proximity_ros

#include "src/ros/server/check_service.hpp"

#include <algorithm>

#include "fiber_proximity/environment/check_fibers.hpp"
#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/inputs/fixed_frame.hpp"
#include "src/ros/server/motion_check.hpp"
#include "src/ros/server/request_options.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber_proximity::CheckFibers;
using fiber_proximity::Contact;

/// Candidates of a request that are checked at once: those of the same names in a row, which may
/// touch the same, and not so many that it takes long to see that a deadline has come.
class Block {
 public:
  static constexpr std::size_t most_candidates = 256;

  /// Reads the block that begins at this candidate.
  Block(const CheckFibers::Request& request, std::size_t begin, const QueryTarget& target)
      : names_(request.candidates[begin].names) {
    const std::size_t end = std::min(request.candidates.size(), begin + most_candidates);
    for (std::size_t i = begin;
         i < end && request.candidates[i].names == names_ && !(i > begin && target.is_time_up());
         ++i) {
      candidates_.push_back(naming("candidate " + std::to_string(i), [&] {
        return to_candidate(request.candidates[i], target.frame);
      }));
    }
  }

  const std::vector<std::string>& names() const { return names_; }
  const std::vector<fiber::FiberAssembly>& candidates() const { return candidates_; }

 private:
  const std::vector<std::string>& names_;
  std::vector<fiber::FiberAssembly> candidates_;
};

fiber::QueryOptions validated_options(const CheckFibers::Request& request,
                                      const fiber::QueryOptions& defaults) {
  fiber::QueryOptions options = to_options(request, defaults);
  options.neighbour_skip = defaults.neighbour_skip;
  options.neighbour_skip_length = defaults.neighbour_skip_length;
  fiber::validate(options);
  return options;
}

void append(const fiber::QueryResult& result, std::uint8_t body_b,
            CheckFibers::Response& response) {
  for (const fiber::Contact& contact : result.contacts) {
    Contact message;
    to_message(contact, Contact::CANDIDATE, body_b, message);
    response.contacts.push_back(message);
  }
}

void append(const fiber::FiberCheck& check, const PresentFibers& present,
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

void answer_candidates(const CheckFibers::Request& request, const QueryTarget& target,
                       const FindAllowed& find_allowed, CheckFibers::Response& response) {
  fiber::QueryOptions options = validated_options(request, target.defaults);
  const PresentFibers present(target, request);
  fiber::Surroundings surroundings = present.surroundings();
  const std::size_t count = request.candidates.size();
  response.offsets.push_back(0);
  std::vector<fiber::FiberCheck> checks;
  while (response.free.size() < count && !target.is_time_up()) {
    const Block block(request, response.free.size(), target);
    surroundings.allowed = find_allowed(block.names());
    options.deadline = target.time_for_query();
    options.contact_limit =
        share_of_contacts(target.defaults.contact_limit, response.contacts.size(),
                          queries_per_candidate * block.candidates().size());
    check_fibers(block.candidates(), surroundings, options, checks);
    for (const fiber::FiberCheck& check : checks) {
      append(check, present, response);
    }
  }
  leave_unread(count, response);
}

}  // namespace

void answer(const CheckFibers::Request& request, const QueryTarget& target,
            const FindAllowed& find_allowed, CheckFibers::Response& response) {
  if (request.waypoint_offsets.empty()) {
    answer_candidates(request, target, find_allowed, response);
  } else {
    answer_motions(request, target, find_allowed, response);
  }
  if (request.gradients) {
    std::for_each(response.contacts.begin(), response.contacts.end(), add_gradients);
  }
}

}  // namespace fiber_proximity_ros

#include "src/mpi/earliest_contacts.hpp"

#include <algorithm>

#include "src/mpi/kth_smallest.hpp"
#include "src/query/motion_evaluator.hpp"

namespace fiber {

void keep_earliest(const Communicator& ranks, const MotionOptions& options,
                   DistributedMotionResult& result) {
  result.complete = ranks.all(result.complete);
  result.limit_reached = !ranks.all(!result.limit_reached);
  if (result.limit_reached) {  // there are more pairs than may be examined: none is reported
    result.contacts.clear();
    result.touching.clear();
  }
  double others_lower = result.complete ? 1.0 : 0.0;
  const auto touching_key = [](const DistributedMotionContact& contact) {
    return pair_key_of(0.0, contact);
  };
  const bool are_more_touching =
      options.contact_limit > 0 && keep_k_smallest(
                                       ranks, options.contact_limit, touching_key,
                                       [](const auto& /*contact*/) {}, result.touching);
  const auto time_key = [](const DistributedMotionContact& contact) {
    return pair_key_of(contact.lower, contact);
  };
  const std::uint64_t max_contacts = max_reported(options);
  const bool are_more =
      max_contacts > 0 &&
      keep_k_smallest(
          ranks, max_contacts, time_key,
          [&](const auto& contact) { others_lower = std::min(others_lower, contact.lower); },
          result.contacts);
  std::sort(result.contacts.begin(), result.contacts.end(), by_key);
  std::sort(result.touching.begin(), result.touching.end(), by_key);
  result.limit_reached =
      result.limit_reached || are_more_touching || (are_more && options.type != MotionType::FIRST);
  result.others_lower = ranks.min(are_more_touching ? 0.0 : others_lower);
}

}  // namespace fiber

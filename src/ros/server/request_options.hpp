#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "fiber_proximity/QueryProximity.h"
#include "fiber_proximity/query/options.hpp"
#include "src/ros/server/query_settings.hpp"

namespace fiber_proximity_ros {

/// The type of this number, as the requests have them.
/// @throws std::invalid_argument listing the numbers
inline fiber::QueryType to_query_type(std::uint8_t type) {
  using Request = fiber_proximity::QueryProximity::Request;
  switch (type) {
    case Request::FIRST:
      return fiber::QueryType::FIRST;
    case Request::CLOSEST:
      return fiber::QueryType::CLOSEST;
    case Request::LIMITED:
      return fiber::QueryType::LIMITED;
    case Request::ALL:
      return fiber::QueryType::ALL;
    case Request::FIBER_PAIRS:
      return fiber::QueryType::FIBER_PAIRS;
    default:
      throw std::invalid_argument("type is " + std::to_string(type) +
                                  ", it must be 0 (FIRST), 1 (CLOSEST), 2 (LIMITED), 3 (ALL) or 4 "
                                  "(FIBER_PAIRS)");
  }
}

/// What requests of all services have in common; they must be validated yet.
/// @throws std::invalid_argument for an unknown type or kernel
template <class Request>
fiber::QueryOptions to_options(const Request& request, const fiber::QueryOptions& defaults) {
  fiber::QueryOptions options;
  options.type = to_query_type(request.type);
  options.margin = request.margin;
  options.max_contacts = request.max_contacts;
  options.kernel =
      request.kernel.empty()
          ? defaults.kernel
          : fiber::kernel_from_name(current_kernel_name("kernel of a request", request.kernel));
  options.deadline = request.deadline;
  options.contact_limit = defaults.contact_limit;
  options.pair_limit = defaults.pair_limit;
  return options;
}

/// How many contacts each of the next queries of a request may report where the response may have
/// so many; at least one.
/// @param limit of the response, 0 for none
inline std::uint32_t share_of_contacts(std::uint32_t limit, std::size_t reported,
                                       std::size_t queries) {
  if (limit == 0) {
    return 0;
  }
  const std::size_t left = limit - std::min<std::size_t>(reported, limit);
  return static_cast<std::uint32_t>(std::max<std::size_t>(left / queries, 1));
}

}  // namespace fiber_proximity_ros

#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "fiber_proximity/ProximityConfig.h"
#include "fiber_proximity/query/options.hpp"

namespace fiber_proximity_ros {

/// The query that the node's dynamic parameters ask for.
/// @throws std::invalid_argument naming the parameter, its value and what is allowed
fiber::QueryOptions to_query_options(const fiber_proximity::ProximityConfig& config);

/// The type of this number, as the requests have them.
/// @throws std::invalid_argument listing the numbers
fiber::QueryType to_query_type(std::uint8_t type);

/// The options that requests of all services have in common; they are not validated yet.
/// @throws std::invalid_argument for an unknown type or kernel
template <class Request>
fiber::QueryOptions to_options(const Request& request, const fiber::QueryOptions& defaults) {
  fiber::QueryOptions options;
  options.type = to_query_type(request.type);
  options.margin = request.margin;
  options.max_contacts = request.max_contacts;
  options.kernel =
      request.kernel.empty() ? defaults.kernel : fiber::kernel_from_name(request.kernel);
  options.deadline = request.deadline;
  options.contact_limit = defaults.contact_limit;
  options.pair_limit = defaults.pair_limit;
  return options;
}

/// How many contacts each of the next queries of a request may report where the response may have
/// so many; at least one.
/// @param limit of the response, 0 for none
std::uint32_t share_of_contacts(std::uint32_t limit, std::size_t reported, std::size_t queries);

}  // namespace fiber_proximity_ros

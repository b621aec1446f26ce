#include "src/ros/server/query_options.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "src/ros/server/accuracy_preset.hpp"

namespace fiber_proximity_ros {
fiber::QueryOptions to_query_options(const fiber_proximity::ProximityConfig& config) {
  fiber::QueryOptions options;
  options.type = fiber::query_type_from_name(config.query_type);
  options.margin = config.margin;
  options.max_contacts = static_cast<std::uint32_t>(config.max_contacts);
  options.pairing = fiber::pairing_from_name(config.pairing);
  if (config.neighbour_skip >= 0) {
    options.neighbour_skip = static_cast<std::uint32_t>(config.neighbour_skip);
  }
  if (config.neighbour_skip_length >= 0.0) {
    options.neighbour_skip_length = config.neighbour_skip_length;
  }
  options.kernel = fiber::kernel_from_name(config.kernel);
  options.tolerance = config.tolerance;
  options.relative_tolerance = config.relative_tolerance;
  options.deadline = config.deadline;
  options.contact_limit = static_cast<std::uint32_t>(config.contact_limit);
  options.pair_limit = static_cast<std::uint64_t>(config.pair_limit);
  fiber::validate(options);
  apply_accuracy(config.accuracy, options);
  return options;
}

fiber::QueryType to_query_type(std::uint8_t type) {
  // As QueryProximity numbers them.
  constexpr std::array types{fiber::QueryType::FIRST, fiber::QueryType::CLOSEST,
                             fiber::QueryType::LIMITED, fiber::QueryType::ALL,
                             fiber::QueryType::FIBER_PAIRS};
  if (type >= types.size()) {
    throw std::invalid_argument("type is " + std::to_string(type) +
                                ", it must be 0 (FIRST), 1 (CLOSEST), 2 (LIMITED), 3 (ALL) or 4 "
                                "(FIBER_PAIRS)");
  }
  return types[type];
}

std::uint32_t share_of_contacts(std::uint32_t limit, std::size_t reported, std::size_t queries) {
  if (limit == 0) {
    return 0;
  }
  const std::size_t left = limit - std::min<std::size_t>(reported, limit);
  return static_cast<std::uint32_t>(std::max<std::size_t>(left / queries, 1));
}

}  // namespace fiber_proximity_ros

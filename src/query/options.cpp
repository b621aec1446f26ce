#include "fiber_proximity/query/options.hpp"

#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace fiber {

namespace {

void check_finite(const char* name, double value, const char* unit) {
  if (!(value >= 0.0 && std::isfinite(value))) {
    throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) +
                                ", it must be finite and at least 0" + unit);
  }
}

}  // namespace

void validate(const QueryOptions& options) {
  if (!(options.margin >= 0.0)) {
    throw std::invalid_argument("margin is " + std::to_string(options.margin) +
                                ", it must be at least 0 m (infinity for no limit)");
  }
  if (!(options.neighbour_skip_length.value_or(0.0) >= 0.0)) {
    throw std::invalid_argument("neighbour_skip_length is " +
                                std::to_string(*options.neighbour_skip_length) +
                                ", it must be at least 0 m");
  }
  if (options.type == QueryType::LIMITED && options.max_contacts == 0) {
    throw std::invalid_argument("max_contacts is 0, a limited query needs at least 1");
  }
  check_finite("tolerance", options.tolerance, " m");
  check_finite("relative_tolerance", options.relative_tolerance, "");
  check_finite("deadline", options.deadline, " s (0 for none)");
}

QueryType query_type_from_name(const std::string& name) {
  static const std::array<std::pair<const char*, QueryType>, 5> types{
      {{"first", QueryType::FIRST},
       {"closest", QueryType::CLOSEST},
       {"limited", QueryType::LIMITED},
       {"all", QueryType::ALL},
       {"fiber_pairs", QueryType::FIBER_PAIRS}}};
  for (const auto& [type_name, type] : types) {
    if (name == type_name) {
      return type;
    }
  }
  throw std::invalid_argument("unknown query type '" + name +
                              "', known are: first, closest, limited, all, fiber_pairs");
}

Pairing pairing_from_name(const std::string& name) {
  if (name == "all") {
    return Pairing::ALL;
  }
  if (name == "same_fiber") {
    return Pairing::SAME_FIBER;
  }
  if (name == "different_fibers") {
    return Pairing::DIFFERENT_FIBERS;
  }
  throw std::invalid_argument("unknown pairing '" + name +
                              "', known are: all, same_fiber, different_fibers");
}

}  // namespace fiber

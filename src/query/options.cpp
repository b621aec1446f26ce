#include "fiber_proximity/query/options.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "src/text/join.hpp"

namespace fiber {

namespace {

void check_finite(const char* name, double value, const char* unit) {
  if (!(value >= 0.0 && std::isfinite(value))) {
    throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) +
                                ", it must be finite and at least 0" + unit);
  }
}

/// @param names in the order of the enumerators
template <class Enum>
Enum from_name(const char* what, const std::string& name, const std::vector<std::string>& names) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw std::invalid_argument(std::string("unknown ") + what + " '" + name +
                                "', known are: " + join(names));
  }
  return static_cast<Enum>(found - names.begin());
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
  return from_name<QueryType>("query type", name,
                              {"first", "closest", "limited", "all", "fiber_pairs"});
}

Pairing pairing_from_name(const std::string& name) {
  return from_name<Pairing>("pairing", name, {"all", "same_fiber", "different_fibers"});
}

}  // namespace fiber

#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

namespace fiber {

/// @param what, unit, rule what the error says of the value
/// @throws std::invalid_argument unless the rule is met
inline void require(bool is_met, const std::string& what, double value, const char* unit,
                    const char* rule) {
  if (!is_met) {
    throw std::invalid_argument(what + " is " + std::to_string(value) + unit + ", it must be " +
                                rule);
  }
}

inline void require_positive(const std::string& what, double value, const char* unit = "") {
  require(std::isfinite(value) && value > 0.0, what, value, unit, "positive and finite");
}

inline void require_not_negative(const std::string& what, double value, const char* unit = "") {
  require(std::isfinite(value) && value >= 0.0, what, value, unit, "at least 0 and finite");
}

inline void require_share(const std::string& what, double value) {
  require(value >= 0.0 && value <= 1.0, what, value, "", "from 0 to 1");
}

}  // namespace fiber

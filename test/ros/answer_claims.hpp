#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <regex>
#include <string>

/// What a reader takes from the node's text about an answer.
namespace answer_claims {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Claims about pairs: how many contacts there are, and how near the closest pair is.
struct Claims {
  std::size_t min_contacts = 0;
  std::size_t max_contacts = std::numeric_limits<std::size_t>::max();
  double others_lower = -infinity;   // [m] of all but the min_contacts closest
  double minimum_lower = -infinity;  // [m]
  double minimum_upper = infinity;   // [m]
};

/// A length with its unit [m].
inline double length_of(const std::string& number, const std::string& unit) {
  const double value = std::stod(number);
  return unit == "mm" ? value / 1000.0 : value;
}

/// Half of what the last digit of a length is worth [m].
inline double half_digit(const std::string& number, const std::string& unit) {
  const std::size_t exponent = number.find('e');
  const std::size_t point = number.find('.');
  const std::string digits = number.substr(0, exponent);
  double last = point == std::string::npos
                    ? 1.0
                    : std::pow(10.0, -static_cast<double>(digits.size() - point - 1));
  if (exponent != std::string::npos) {
    last *= std::pow(10.0, std::stod(number.substr(exponent + 1)));
  }
  return 0.5 * last * (unit == "mm" ? 1e-3 : 1.0);
}

/// Takes the claims from a line about pairs.
inline Claims claims_of(const std::string& line) {
  static const std::string length = R"((-?[0-9.]+(?:e[+-]?[0-9]+)?) (mm|m)\b)";
  std::smatch found;
  Claims claims;
  const auto has = [&](const std::string& pattern) {
    return std::regex_search(line, found, std::regex(pattern));
  };
  const auto told = [&](int at) { return length_of(found[at], found[at + 1]); };
  if (has(R"((\d+) of (\d+) )")) {
    EXPECT_EQ(found[1], found[2]) << line;
    claims.min_contacts = claims.max_contacts = std::stoul(found[1]);
  } else if (has(R"((?:at least|the closest) (\d+) )")) {
    claims.min_contacts = std::stoul(found[1]);
  } else if (has(": in contact")) {
    claims.min_contacts = 1;
  } else if (has(": no contact( within " + length + ")?[^,]*") &&
             found[0].str().find("found") == std::string::npos) {
    claims.max_contacts = 0;
  }
  if (has("any other >= " + length)) {
    claims.others_lower = told(1);
  }
  if (has("no pair(?!s)")) {
    claims.minimum_lower = infinity;
  } else if (has("closest true >= " + length)) {
    claims.minimum_lower = told(1);
  } else if (has("(closest|penetration) (known )?" + length)) {
    const bool is_deep = found[1] == "penetration";
    const double sign = is_deep ? -1.0 : 1.0;
    const double half = half_digit(found[3], found[4]);
    const double distance = sign * told(3);
    claims.minimum_upper = distance + half;
    const std::string rest = found.suffix();
    std::smatch bound;
    const auto goes_on = [&](const std::string& pattern) {
      return std::regex_search(rest, bound, std::regex("^" + pattern));
    };
    if (goes_on(R"( \(to )" + length)) {
      const double error = length_of(bound[1], bound[2]);
      claims.minimum_lower = distance - half - error;
      claims.minimum_upper += error;
    } else if (goes_on(", true >= " + length)) {
      claims.minimum_lower = length_of(bound[1], bound[2]);
    } else if (goes_on(", true <= " + length)) {
      claims.minimum_lower = -length_of(bound[1], bound[2]);
    } else if (goes_on(", true " + length + " to " + length)) {
      claims.minimum_lower = length_of(bound[1], bound[2]);
      claims.minimum_upper = length_of(bound[3], bound[4]);
    }
  }
  return claims;
}

}  // namespace answer_claims

// Functions that make the tables of keys in keys.cpp and effect_keys.cpp.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "src/sim/scene/keys.hpp"
#include "src/text/join.hpp"

namespace fiber {

inline constexpr const char* needed = "required";  ///< in place of a default
inline constexpr const char* three_numbers = "three numbers";
inline constexpr const char* a_direction = "three numbers, a direction";
inline constexpr double unlimited = std::numeric_limits<double>::infinity();

inline constexpr KeyLimits above_0{0.0, unlimited, true, false};
inline constexpr KeyLimits at_least_0{0.0, unlimited, false, false};
inline constexpr KeyLimits from_0_to_1{0.0, 1.0, false, false};

inline std::string text_of(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

inline SceneKey other_key(const char* name, const std::string& allowed,
                          const std::string& by_default, const char* unit, const char* text) {
  return {name, allowed, by_default, unit, text, {}, std::nullopt};
}

inline SceneKey number_key(const char* name, const KeyLimits& limits, const std::string& by_default,
                           const char* unit, const char* text) {
  return {name,       (limits.excludes_min ? "a number " : "a number of ") + limits.text(),
          by_default, unit,
          text,       {},
          limits};
}

inline SceneKey number_key(const char* name, const KeyLimits& limits, double by_default,
                           const char* unit, const char* text) {
  SceneKey key = number_key(name, limits, text_of(by_default), unit, text);
  key.numbers = {by_default};
  return key;
}

inline SceneKey count_key(const char* name, double max, const std::string& by_default,
                          const char* text) {
  std::ostringstream allowed;
  allowed << "a whole number from 1 to " << static_cast<std::int64_t>(max);
  return {name, allowed.str(), by_default, "", text, {}, KeyLimits{1.0, max, false, false}};
}

inline SceneKey vector_key(const char* name, const std::vector<double>& by_default,
                           const char* unit, const char* text) {
  std::vector<std::string> numbers;
  for (const double each : by_default) {
    numbers.push_back(text_of(each));
  }
  return {name, three_numbers, "[" + join(numbers) + "]", unit, text, by_default, std::nullopt};
}

/// The maps of all effects, and of the entries of their lists.
std::vector<SceneMap> effect_maps();

}  // namespace fiber

#pragma once

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/tools/command_line.hpp"

namespace fiber {

/// The families of these names, or all without names.
/// @throws std::invalid_argument for an unknown name, listing the names
template <class Family>
std::vector<Family> chosen_families(const std::vector<Family>& all,
                                    const std::vector<std::string>& names) {
  if (names.empty()) {
    return all;
  }
  std::vector<Family> chosen;
  for (const std::string& name : names) {
    const auto found = std::find_if(all.begin(), all.end(),
                                    [&](const Family& family) { return family.name == name; });
    if (found == all.end()) {
      std::vector<std::string> known;
      for (const Family& family : all) {
        known.push_back(family.name);
      }
      throw std::invalid_argument("unknown family '" + name + "', known are: " + join(known));
    }
    chosen.push_back(*found);
  }
  return chosen;
}

}  // namespace fiber

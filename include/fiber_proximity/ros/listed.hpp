#pragma once

#include <string>

namespace fiber_proximity_ros {

/// Words as a sentence lists them.
template <class Words>
std::string listed(const Words& words) {
  std::string list;
  for (const std::string& word : words) {
    list += (list.empty() ? "" : ", ") + word;
  }
  return list;
}

}  // namespace fiber_proximity_ros

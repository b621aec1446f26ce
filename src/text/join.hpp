#pragma once

#include <string>

namespace fiber {

/// Words with commas between them.
template <class Words>
std::string join(const Words& words) {
  std::string list;
  for (const std::string& word : words) {
    list += (list.empty() ? "" : ", ") + word;
  }
  return list;
}

}  // namespace fiber

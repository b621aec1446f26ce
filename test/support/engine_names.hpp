#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "fiber_proximity/paper/paper_engines.hpp"
#include "fiber_proximity/query/engine.hpp"

namespace fiber::test {

/// Whether tests ask every engine of the paper: FIBER_PROXIMITY_TEST_ENGINES is `all`, as
/// scripts/test.sh -L all sets it.
inline bool all_engines_wanted() {
  const char* const wanted = std::getenv("FIBER_PROXIMITY_TEST_ENGINES");
  return wanted != nullptr && std::string_view(wanted) == "all";
}

/// Names of our engines, and of one of each kind of the paper's hierarchies (layered, spatial,
/// cascaded), which shares the code of the others of its kind but for their volumes.
inline std::vector<std::string> engine_names_of_each_kind() {
  register_paper_engines();
  constexpr std::array<std::string_view, 5> one_of_each_kind{"run_tree", "brute_force", "AL",
                                                             "DS-20", "SW"};
  std::vector<std::string> names = engine_names();
  names.erase(std::remove_if(names.begin(), names.end(),
                             [&](const std::string& name) {
                               return std::find(one_of_each_kind.begin(), one_of_each_kind.end(),
                                                name) == one_of_each_kind.end();
                             }),
              names.end());
  return names;
}

/// The same, or all of the paper's where they are wanted.
inline std::vector<std::string> all_engine_names() {
  register_paper_engines();
  return all_engines_wanted() ? engine_names() : engine_names_of_each_kind();
}

}  // namespace fiber::test

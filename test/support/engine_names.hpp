#pragma once

#include <string>
#include <vector>

#include "fiber_proximity/paper/paper_engines.hpp"
#include "fiber_proximity/query/engine.hpp"

namespace fiber::test {

/// Names of all engines, the paper's among them.
inline std::vector<std::string> all_engine_names() {
  register_paper_engines();
  return engine_names();
}

}  // namespace fiber::test

#pragma once

#include <string>
#include <vector>

#include "fiber_proximity/query/options.hpp"

namespace fiber {

/// A query with one choice of what its accuracy may cost.
struct AccuracySetting {
  std::string query;  ///< contacts, closest or fiber_pairs
  std::string name;   ///< of the choice
  QueryOptions options;
  double deadline_part = 0.0;  ///< deadline as a part of what the reference takes; 0 for none
  bool is_reference = false;   ///< kernel robust, no tolerance, no deadline
};

/// All settings that are compared, the reference of each query first. Tolerances are parts of the
/// fibres' radius [m].
std::vector<AccuracySetting> accuracy_settings(double radius);

}  // namespace fiber

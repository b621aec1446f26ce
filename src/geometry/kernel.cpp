#include "fiber_proximity/geometry/kernel.hpp"

#include <algorithm>
#include <stdexcept>

namespace fiber {

const std::vector<std::string>& kernel_names() {
  static const std::vector<std::string> names{"fast", "robust", "exact"};
  return names;
}

Kernel kernel_from_name(const std::string& name) {
  const std::vector<std::string>& names = kernel_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw std::invalid_argument("unknown kernel '" + name + "', known are: fast, robust, exact");
  }
  return static_cast<Kernel>(found - names.begin());
}

}  // namespace fiber

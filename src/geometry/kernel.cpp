#include "fiber_proximity/geometry/kernel.hpp"

#include <algorithm>
#include <cassert>
#include <stdexcept>

#include "fiber_proximity/geometry/exact_distance.hpp"
#include "fiber_proximity/geometry/segment_distance.hpp"
#include "src/text/join.hpp"
#include "src/text/quote.hpp"

namespace fiber {

const std::vector<std::string>& kernel_names() {
  static const std::vector<std::string> names{"robust", "exact"};
  return names;
}

Kernel kernel_from_name(const std::string& name) {
  const std::vector<std::string>& names = kernel_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw std::invalid_argument("unknown kernel " + quote(name) + ", known are: " + join(names));
  }
  return static_cast<Kernel>(found - names.begin());
}

std::string current_kernel_name(const std::string& name) {
  return name == "fast" ? name_of(Kernel::ROBUST) : name;
}

SegmentDistance segment_distance(Kernel kernel, const Eigen::Vector3d& p0,
                                 const Eigen::Vector3d& p1, const Eigen::Vector3d& q0,
                                 const Eigen::Vector3d& q1) {
  switch (kernel) {
    case Kernel::ROBUST:
      return segment_distance(p0, p1, q0, q1);
    case Kernel::EXACT:
      return exact_segment_distance(p0, p1, q0, q1);
  }
  assert(false);
  return {};
}

}  // namespace fiber

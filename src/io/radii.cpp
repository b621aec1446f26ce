#include "src/io/radii.hpp"

#include <stdexcept>
#include <string>

#include "src/io/number.hpp"

namespace fiber {

void check_default_radius(double radius) {
  if (!FiberAssembly::is_valid_radius(radius)) {
    std::string value;
    append_number(value, radius);
    throw std::invalid_argument("the default radius is " + value + ", " +
                                FiberAssembly::radius_rule);
  }
}

std::vector<double> shared_if_equal(std::vector<double> radii) {
  for (const double radius : radii) {
    if (radius != radii.front()) {
      return radii;
    }
  }
  radii.resize(1);
  return radii;
}

double point_radius(const FiberAssembly& fibers, std::size_t fiber, std::size_t point) {
  const std::vector<double>& radii = fibers.radii();
  if (radii.size() == 1) {
    return radii.front();
  }
  return radii.size() == fibers.fiber_count() ? radii[fiber] : radii[point];
}

}  // namespace fiber

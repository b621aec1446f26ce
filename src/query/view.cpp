#include "fiber_proximity/query/view.hpp"

#include <sstream>
#include <stdexcept>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {
namespace {

void check(const char* name, const Eigen::Vector3d& vector) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!FiberAssembly::is_valid_coordinate(vector[axis])) {
      std::ostringstream message;
      message << name << ": "
              << "xyz"[axis] << " is " << vector[axis] << ", " << FiberAssembly::coordinate_rule;
      throw std::invalid_argument(message.str());
    }
  }
}

}  // namespace

void validate(const View& view) {
  check("direction of view", view.direction);
  if (view.direction == Eigen::Vector3d::Zero()) {
    throw std::invalid_argument("direction of view: is 0,0,0, it must have a length");
  }
  if (view.is_perspective) {
    check("eye", view.eye);
  }
}

}  // namespace fiber

#pragma once

#include <memory>

#include "fiber_proximity/environment/world.hpp"
#include "src/python/arrays.hpp"
#include "src/python/shared.hpp"

namespace fiber::python {

/// The class Environment of Python: a World, of which each query sees a snapshot.
class SharedWorld : public World, public OnlyShared {};

/// A pose: (4, 4), a position (3,), a position and a quaternion x y z w (7,), or None.
Eigen::Isometry3d to_pose(const py::object& object, const char* name = "pose");

/// Pairs that are left out: names of objects, or tuples of name, fibre or None, and first and last
/// segment or None.
AllowedPairs to_allowed(const py::object& object);

/// The environment of an argument, null for None.
std::shared_ptr<const Environment> to_environment(const py::object& object);

/// Adds what makes objects to the class.
void bind_shapes(py::class_<SharedWorld, std::shared_ptr<SharedWorld>>& environment);

}  // namespace fiber::python

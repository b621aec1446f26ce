#pragma once

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/python/arrays.hpp"

namespace fiber::python {

/// The fibres that arguments of Python describe.
/// @param points (n, 3), or without offsets (fibres, n, 3) or a list of curves, (n, 3) each [m]
/// @param offsets None: one fibre
/// @param radii a number, (fibres,) or (n,); of curves also a list of a number or (n,) for each
/// @param closed a bool for all, (fibres,) of bool, or None
/// @param joints (n,) of whole numbers, or None; warns of one that one point alone has
/// @param joint_tolerance [m], or None
FiberAssembly make_fibers(const py::object& points, const py::object& offsets,
                          const py::object& radii, const py::object& closed,
                          const py::object& joints, const py::object& joint_tolerance);

}  // namespace fiber::python

#pragma once

#include <vector>

#include "fiber_proximity/environment/check_fibers.hpp"
#include "src/python/arrays.hpp"

namespace fiber::python {

/// Candidates of an argument: (m, n, 3), (m, fibres, n, 3), or a sequence of Fibers.
/// @param radii of those that are arrays
std::vector<FiberAssembly> to_candidates(const py::object& candidates, const py::object& radii);

/// Motions: (m, states, n, 3), (m, states, fibres, n, 3), or a sequence of sequences of Fibers.
std::vector<FiberPath> to_paths(const py::object& motions, const py::object& radii);

}  // namespace fiber::python

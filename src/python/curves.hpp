#pragma once

#include <cstdint>
#include <vector>

#include "src/python/arrays.hpp"

namespace fiber::python {

/// Curves, one after the other, as an assembly holds them.
struct Curves {
  std::vector<Eigen::Vector3d> points;  ///< [m]
  std::vector<std::uint32_t> offsets;   ///< of each curve's first point, then the number of points
};

/// Whether it is a list or tuple with a curve in it, (n, 3), and not one of points.
bool is_list_of_curves(const py::object& object);

/// @throws as to_points(), naming the curve
Curves to_curves(const py::object& list, const char* name);

/// Radii of curves: a number, one-dimensional numbers, or a list of a number or (n,) for each.
/// @throws as to_numbers(), naming the curve
std::vector<double> to_radii(const py::object& object, const std::vector<std::uint32_t>& offsets);

}  // namespace fiber::python

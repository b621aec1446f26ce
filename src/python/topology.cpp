#include <pybind11/stl.h>

#include "fiber_proximity/query/crossings.hpp"
#include "src/python/bindings.hpp"
#include "src/python/fibers.hpp"

namespace fiber::python {
namespace {

py::dtype crossing_dtype() {
  const Crossing crossing{};
  const auto at = [&](auto member) { return offset_of(crossing, member); };
  return make_dtype({{"fiber_a", "u4", at(&Crossing::fiber_a)},
                     {"segment_a", "u4", at(&Crossing::segment_a)},
                     {"s", "f8", at(&Crossing::s)},
                     {"fiber_b", "u4", at(&Crossing::fiber_b)},
                     {"segment_b", "u4", at(&Crossing::segment_b)},
                     {"t", "f8", at(&Crossing::t)},
                     {"a_is_over", "?", at(&Crossing::a_is_over)},
                     {"sign", "i4", at(&Crossing::sign)},
                     {"separation", "f8", at(&Crossing::separation)},
                     {"gap", "f8", at(&Crossing::gap)},
                     {"point_a", "(3,)f8", at(&Crossing::point_a)},
                     {"point_b", "(3,)f8", at(&Crossing::point_b)}},
                    sizeof(Crossing));
}

py::dtype linking_dtype() {
  const LinkingNumber number;
  return make_dtype({{"fiber_a", "u4", offset_of(number, &LinkingNumber::fiber_a)},
                     {"fiber_b", "u4", offset_of(number, &LinkingNumber::fiber_b)},
                     {"value", "i8", offset_of(number, &LinkingNumber::value)}},
                    sizeof(LinkingNumber));
}

py::array crossings(const py::object& fibers, const py::object& direction, const py::object& eye) {
  const Fibers::State state = to_state(fibers, "fibers");
  View seen;
  seen.direction = to_vector(direction, "direction");
  seen.is_perspective = !eye.is_none();
  if (seen.is_perspective) {
    seen.eye = to_vector(eye, "eye");
  }
  std::vector<Crossing> found;
  {
    const WithoutPythonLock others_may_run;
    found = find_crossings(*state, seen);
  }
  return to_array(crossing_dtype(), found);
}

py::array all_linking_numbers(const py::object& fibers) {
  const Fibers::State state = to_state(fibers, "fibers");
  std::vector<LinkingNumber> found;
  {
    const WithoutPythonLock others_may_run;
    found = linking_numbers(*state);
  }
  return to_array(linking_dtype(), found);
}

std::int64_t linking_number_of(const py::object& curve_a, const py::object& curve_b) {
  const auto a = to_points(curve_a, "curve_a");
  const auto b = to_points(curve_b, "curve_b");
  const WithoutPythonLock others_may_run;
  return linking_number(a, b);
}

double writhe_of(const py::object& curve, bool closed) {
  const std::vector<Eigen::Vector3d> points = to_points(curve, "points");
  for (const Eigen::Vector3d& point : points) {
    require_coordinates("a point", point);
  }
  const WithoutPythonLock others_may_run;
  return writhe(points, closed ? CurveEnds::CLOSED : CurveEnds::OPEN);
}

}  // namespace

void bind_topology(py::module& module) {
  module.attr("crossing_dtype") = crossing_dtype();
  module.attr("linking_dtype") = linking_dtype();
  module.def("crossings", &crossings, py::arg("fibers"),
             py::arg("direction") = py::make_tuple(0.0, 0.0, -1.0), py::arg("eye") = py::none(), R"(
Where fibres cross over and under each other and themselves, as a viewer sees them.

Which segments cross, which is above, and the sign are decided without rounding.

Parameters
----------
fibers : Fibers
direction : (3,), default (0, 0, -1)
    Along which the viewer looks.
eye : (3,) [m], optional
    Where a camera is; without, all rays of sight are parallel.

Returns
-------
(m,) of ``crossing_dtype``
    Sorted by fiber_a, segment_a, fiber_b, segment_b; fields as in the message Crossing.

>>> from fiber_proximity import Fibers, crossings
>>> fibers = Fibers([[0, 0, 0], [1, 0, 0], [.5, -1, 1], [.5, 1, 1]], [0, 2, 4])
>>> crossings(fibers)[["fiber_b", "a_is_over", "separation"]].tolist()
[(1, False, 1.0)]
)");
  module.def("linking_numbers", &all_linking_numbers, py::arg("fibers"), R"(
How often fibres, each closed from its last point to its first, are wound around each other.

Returns
-------
(m,) of ``linking_dtype``
    Of all pairs of fibres whose number is not 0, sorted by fibre: fiber_a, fiber_b, value; exact.
)");
  module.def("linking_number", &linking_number_of, py::arg("curve_a"), py::arg("curve_b"), R"(
The Gauss linking number of two closed polygons (n, 3) [m], an int without error.

>>> from fiber_proximity import linking_number
>>> linking_number([[-1, -1, 0], [1, -1, 0], [0, 1, 0]], [[0, 0, -1], [0, 0, 1], [0, 3, 0]])
1
)");
  module.def("writhe", &writhe_of, py::arg("points"), py::arg("closed") = false,
             "The writhe of a polygon (n, 3) [m]: the mean over all directions of view of the sum "
             "of the signs of its crossings with itself. The time is that of n * n pairs.");
}

}  // namespace fiber::python

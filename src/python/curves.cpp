#include "src/python/curves.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace fiber::python {
namespace {

/// Dimensions of an array; of a list how deep lists are in each other, by the first of each, as far
/// as matters here.
Py_ssize_t dimensions_of(const py::handle& object, Py_ssize_t most = 3) {
  if (py::isinstance<py::array>(object)) {
    return py::reinterpret_borrow<py::array>(object).ndim();
  }
  if (!is_list(object)) {
    return 0;
  }
  if (most == 1 || PySequence_Fast_GET_SIZE(object.ptr()) == 0) {
    return 1;
  }
  return 1 + dimensions_of(PySequence_Fast_GET_ITEM(object.ptr(), 0), most - 1);
}

std::string item_name(const char* name, std::size_t index) {
  return std::string(name) + "[" + std::to_string(index) + "]";
}

}  // namespace

bool is_list_of_curves(const py::object& object) {
  return is_list(object) && std::any_of(object.begin(), object.end(), [](const py::handle& item) {
           return dimensions_of(item) == 2;
         });
}

Curves to_curves(const py::object& list, const char* name) {
  Curves curves;
  curves.offsets.push_back(0);
  for (const py::handle item : list) {
    const std::string place = item_name(name, curves.offsets.size() - 1);
    const std::vector<Eigen::Vector3d> curve =
        to_points(py::reinterpret_borrow<py::object>(item), place.c_str());
    curves.points.insert(curves.points.end(), curve.begin(), curve.end());
    curves.offsets.push_back(
        to_index(static_cast<std::int64_t>(curves.points.size()), "the number of points"));
  }
  return curves;
}

std::vector<double> to_radii(const py::object& object, const std::vector<std::uint32_t>& offsets) {
  const std::size_t curves = offsets.size() - 1;
  const auto has_many = [](const py::handle& item) { return dimensions_of(item) > 0; };
  if (!is_list(object) || std::none_of(object.begin(), object.end(), has_many)) {
    return to_numbers(object, "radii");
  }
  const auto list = py::reinterpret_borrow<py::sequence>(object);
  if (list.size() != curves) {
    throw std::invalid_argument("radii is a list of " + std::to_string(list.size()) +
                                ", there are " + std::to_string(curves) + " curves");
  }
  std::vector<double> radii;
  for (std::size_t curve = 0; curve < curves; ++curve) {
    const std::string place = item_name("radii", curve);
    const py::object item = list[curve];
    const std::vector<double> given = to_numbers(item, place.c_str());
    const std::size_t count = offsets[curve + 1] - offsets[curve];
    if (dimensions_of(item) == 0) {
      radii.insert(radii.end(), count, given.front());
    } else if (given.size() == count) {
      radii.insert(radii.end(), given.begin(), given.end());
    } else {
      throw std::invalid_argument(place + " has " + std::to_string(given.size()) +
                                  " values, it must be a number or one for each of the " +
                                  std::to_string(count) + " points of curve " +
                                  std::to_string(curve));
    }
  }
  return radii;
}

}  // namespace fiber::python

#include "src/python/arrays.hpp"

#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace fiber::python {
namespace {

static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));

void require_kind(const py::array& array, const std::string& kinds, const char* name,
                  const char* allowed) {
  if (kinds.find(array.dtype().kind()) == std::string::npos && array.size() > 0) {
    throw py::type_error(std::string(name) + " has the dtype " +
                         std::string(py::str(array.dtype())) + ", it must be " + allowed);
  }
}

/// Whether a value is masked of an array, which may be structured.
bool is_masked(const py::handle& object) {
  const py::module masked_arrays = py::module::import("numpy.ma");
  if (!py::isinstance(object, masked_arrays.attr("MaskedArray"))) {
    return false;
  }
  const py::object mask = masked_arrays.attr("getmaskarray")(object);
  const py::object flat = py::module::import("numpy").attr("ascontiguousarray")(mask);
  return flat.attr("view")("?").attr("any")().cast<bool>();
}

}  // namespace

bool is_list(const py::handle& object) {
  return PyList_Check(object.ptr()) != 0 || PyTuple_Check(object.ptr()) != 0;
}

void refuse_masked(const py::handle& object, const char* name, int levels) {
  if (is_list(object)) {
    for (Py_ssize_t i = 0; levels > 0 && i < PySequence_Fast_GET_SIZE(object.ptr()); ++i) {
      refuse_masked(PySequence_Fast_GET_ITEM(object.ptr(), i), name, levels - 1);
    }
    return;
  }
  // Masked arrays are of a class that is made in Python; what C makes, such as plain arrays and
  // numbers, is told at once.
  if (PyType_HasFeature(Py_TYPE(object.ptr()), Py_TPFLAGS_HEAPTYPE) != 0 && is_masked(object)) {
    throw py::type_error(std::string(name) +
                         " has masked values, it must have none: leave them out, or put numbers "
                         "there by filled()");
  }
}

py::array to_any_array(const py::object& object, const char* name) {
  refuse_masked(object, name);
  try {
    return py::array(object);
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_ValueError)) {
      throw;
    }
    throw std::invalid_argument(std::string(name) +
                                " is no array: " + std::string(py::str(error.value())));
  }
}

Doubles to_doubles(const py::object& object, const char* name) {
  const py::array array = to_any_array(object, name);
  require_kind(array, "fiu", name, "one of real numbers");
  return Doubles(array);
}

void refuse_shape(const py::array& array, const char* name, const char* allowed) {
  std::string shape = "(";
  for (Py_ssize_t i = 0; i < array.ndim(); ++i) {
    shape += (i == 0 ? "" : ", ") + std::to_string(array.shape(i));
  }
  shape += array.ndim() == 1 ? ",)" : ")";
  throw std::invalid_argument(std::string(name) + " has the shape " + shape + ", it must be " +
                              allowed);
}

void copy_points(const double* rows, std::size_t count, std::vector<Eigen::Vector3d>& points) {
  points.resize(count);
  if (count > 0) {
    std::memcpy(points.front().data(), rows, count * sizeof(Eigen::Vector3d));
  }
}

Doubles to_point_array(const py::object& object, const char* name) {
  Doubles array = to_doubles(object, name);
  if (array.ndim() != 2 || array.shape(1) != 3) {
    refuse_shape(array, name, "(n, 3)");
  }
  return array;
}

std::vector<Eigen::Vector3d> to_points(const py::object& object, const char* name) {
  const Doubles array = to_point_array(object, name);
  std::vector<Eigen::Vector3d> points;
  copy_points(array.data(), static_cast<std::size_t>(array.shape(0)), points);
  return points;
}

Eigen::Vector3d to_vector(const py::object& object, const char* name) {
  const Doubles array = to_doubles(object, name);
  if (array.ndim() != 1 || array.shape(0) != 3) {
    refuse_shape(array, name, "(3,)");
  }
  return Eigen::Vector3d(array.at(0), array.at(1), array.at(2));
}

std::vector<double> to_numbers(const py::object& object, const char* name) {
  const Doubles array = to_doubles(object, name);
  if (array.ndim() > 1) {
    refuse_shape(array, name, "a number or (n,)");
  }
  return {array.data(), array.data() + array.size()};
}

std::vector<std::uint32_t> to_indices(const py::object& object, const char* name) {
  const py::array array = to_any_array(object, name);
  require_kind(array, "iu", name, "one of whole numbers");
  if (array.ndim() != 1) {
    refuse_shape(array, name, "(n,)");
  }
  if (array.dtype().kind() == 'u' && array.itemsize() == sizeof(std::uint64_t)) {
    // Would be negative in what comes next.
    const py::array_t<std::uint64_t, py::array::forcecast> large(array);
    for (Py_ssize_t i = 0; i < large.size(); ++i) {
      if (large.at(i) > std::numeric_limits<std::uint32_t>::max()) {
        throw std::invalid_argument(std::string(name) + "[" + std::to_string(i) + "] is " +
                                    std::to_string(large.at(i)) + ", it must be below 2^32");
      }
    }
  }
  const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> wide(array);
  std::vector<std::uint32_t> indices;
  indices.reserve(static_cast<std::size_t>(wide.size()));
  for (Py_ssize_t i = 0; i < wide.size(); ++i) {
    const std::string item = std::string(name) + "[" + std::to_string(i) + "]";
    indices.push_back(to_index(wide.at(i), item.c_str()));
  }
  return indices;
}

std::uint32_t to_index(std::int64_t value, const char* name, std::int64_t least) {
  if (value < least || value > std::numeric_limits<std::uint32_t>::max()) {
    throw std::invalid_argument(std::string(name) + " is " + std::to_string(value) +
                                ", it must be at least " + std::to_string(least) +
                                " and below 2^32");
  }
  return static_cast<std::uint32_t>(value);
}

py::dtype make_dtype(const std::vector<Field>& fields, std::size_t item_size) {
  py::list names;
  py::list formats;
  py::list offsets;
  for (const Field& field : fields) {
    names.append(field.name);
    formats.append(field.format);
    offsets.append(field.offset);
  }
  return py::dtype(names, formats, offsets, static_cast<Py_ssize_t>(item_size));
}

py::array to_array(const std::vector<Eigen::Vector3d>& points) {
  const std::vector<Py_ssize_t> shape{static_cast<Py_ssize_t>(points.size()), 3};
  return py::array_t<double>(shape, points.empty() ? nullptr : points.front().data());
}

py::array to_array(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<Py_ssize_t>(values.size()), values.data());
}

namespace {

py::array read_only(const py::array& array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

}  // namespace

py::array view(const double* values, const std::vector<Py_ssize_t>& shape,
               const py::object& owner) {
  return read_only(py::array_t<double>(shape, values, owner));
}

py::array view(const std::uint32_t* values, std::size_t count, const py::object& owner) {
  return read_only(py::array_t<std::uint32_t>(static_cast<Py_ssize_t>(count), values, owner));
}

}  // namespace fiber::python

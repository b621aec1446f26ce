#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "src/python/python_lock.hpp"

namespace fiber::python {

namespace py = pybind11;

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

// ---- numpy to C++. What is not as it must be raises TypeError (not numbers) or ValueError (their
// shape), naming the argument. Of an array that is not float64 in C order a copy is taken.

/// A list or tuple.
bool is_list(const py::handle& object);

/// @param levels of lists in each other that are looked into: a list may hold itself
/// @throws py::type_error for masked values of numpy.ma, also within lists
void refuse_masked(const py::handle& object, const char* name, int levels = 6);

/// Any array or sequence as numpy sees it.
/// @throws std::invalid_argument where lists in it differ in length; other errors are numpy's own
py::array to_any_array(const py::object& object, const char* name);

/// Any array or sequence of numbers as float64.
Doubles to_doubles(const py::object& object, const char* name);

/// Throws ValueError: the shape is not the one that is allowed.
[[noreturn]] void refuse_shape(const py::array& array, const char* name, const char* allowed);

/// Points (n, 3) [m], as they lie where they do so already.
Doubles to_point_array(const py::object& object, const char* name);

/// Points (n, 3) [m].
std::vector<Eigen::Vector3d> to_points(const py::object& object, const char* name);

/// Copies rows of three; the array may belong to others, who change it meanwhile.
void copy_points(const double* rows, std::size_t count, std::vector<Eigen::Vector3d>& points);

/// Three numbers.
Eigen::Vector3d to_vector(const py::object& object, const char* name);

/// A number, or one-dimensional numbers.
std::vector<double> to_numbers(const py::object& object, const char* name);

/// One-dimensional whole numbers that fit.
std::vector<std::uint32_t> to_indices(const py::object& object, const char* name);

/// A whole number in a range.
std::uint32_t to_index(std::int64_t value, const char* name, std::int64_t least = 0);

// ---- C++ to numpy

/// A field of a structured array, at so many bytes from the begin of the item.
struct Field {
  const char* name;
  const char* format;  ///< as numpy writes it: u4, f8, (3,)f8
  std::size_t offset;
};

py::dtype make_dtype(const std::vector<Field>& fields, std::size_t item_size);

/// Where a member is in its object.
template <class Object, class Base, class Member>
std::size_t offset_of(const Object& object, Member Base::*member) {
  return static_cast<std::size_t>(reinterpret_cast<const char*>(&(object.*member)) -
                                  reinterpret_cast<const char*>(&object));
}

/// A one-dimensional array that owns these values, which are left in no defined state. Many are
/// moved there, few are copied, so that their memory can be used again.
template <class Value>
py::array to_array(const py::dtype& dtype, std::vector<Value>& values) {
  constexpr std::size_t max_copied = 64 * 1024 / sizeof(Value);
  const std::vector<Py_ssize_t> shape{static_cast<Py_ssize_t>(values.size())};
  const std::vector<Py_ssize_t> strides{static_cast<Py_ssize_t>(sizeof(Value))};
  if (values.size() <= max_copied) {
    return py::array(dtype, shape, strides, values.data());
  }
  auto owned = std::make_unique<std::vector<Value>>(std::move(values));
  Value* data = owned->data();
  const py::capsule owner(owned.release(),
                          [](void* held) { delete static_cast<std::vector<Value>*>(held); });
  return py::array(dtype, shape, strides, data, owner);
}

/// One item of a structured array.
template <class Value>
py::object to_record(const py::dtype& dtype, const Value& value) {
  const std::vector<Py_ssize_t> shape{1};
  const std::vector<Py_ssize_t> strides{static_cast<Py_ssize_t>(sizeof(Value))};
  return py::object(py::array(dtype, shape, strides, &value)[py::int_(0)]);
}

/// An array (n, 3) of these values.
py::array to_array(const std::vector<Eigen::Vector3d>& points);
py::array to_array(const std::vector<double>& values);

/// An array that cannot be written, of values that the owner keeps.
py::array view(const double* values, const std::vector<Py_ssize_t>& shape, const py::object& owner);
py::array view(const std::uint32_t* values, std::size_t count, const py::object& owner);

/// Something that views keep alive.
template <class Object>
py::capsule keep(std::shared_ptr<const Object> object) {
  auto* held = new std::shared_ptr<const Object>(std::move(object));
  return py::capsule(
      held, [](void* pointer) { delete static_cast<std::shared_ptr<const Object>*>(pointer); });
}

}  // namespace fiber::python

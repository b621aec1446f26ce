#pragma once

#include <cstddef>
#include <stdexcept>

namespace fiber::python {

/// A base of classes that Python has. All are made by std::make_shared. pybind11 itself makes one,
/// of nothing but memory, where an object is used that Python has made without its constructor:
/// this refuses that.
struct OnlyShared {
  static void* operator new(std::size_t /*size*/) {
    throw std::runtime_error("the object was made without its constructor");
  }
  static void operator delete(void* /*memory*/) {}
};

}  // namespace fiber::python

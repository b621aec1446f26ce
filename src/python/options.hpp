#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "fiber_proximity/query/motion.hpp"
#include "fiber_proximity/query/options.hpp"

namespace fiber::python {

// Options of queries as keywords of Python. The library checks the values; names that it does not
// know raise TypeError, as Python has it.

/// @param keywords names of QueryOptions, strings for what is an enumeration
QueryOptions query_options(const std::string& type, double margin,
                           const pybind11::kwargs& keywords);

/// Options of a question about a motion.
MotionOptions motion_options(const std::string& type, double margin,
                             const pybind11::kwargs& keywords);

}  // namespace fiber::python

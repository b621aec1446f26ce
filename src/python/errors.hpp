#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace fiber::python {

// Files: what the system refuses is an OSError, what is in them and should not be a ValueError.

/// A path as str, bytes or os.PathLike.
std::string to_path(const pybind11::object& object);

/// @throws FileNotFoundError, or another OSError, where the system does not let it be read
void require_readable(const std::string& path);

}  // namespace fiber::python

#include "src/python/errors.hpp"

#include <cerrno>
#include <filesystem>
#include <fstream>

namespace fiber::python {
namespace py = pybind11;

std::string to_path(const py::object& object) {
  PyObject* bytes = nullptr;
  if (PyUnicode_FSConverter(object.ptr(), &bytes) == 0) {
    throw py::error_already_set();
  }
  return std::string(py::reinterpret_steal<py::bytes>(bytes));
}

void require_readable(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) {
    errno = EISDIR;
  } else {
    errno = 0;
    if (std::ifstream(path)) {
      return;
    }
  }
  PyErr_SetFromErrnoWithFilename(PyExc_OSError, path.c_str());
  throw py::error_already_set();
}

}  // namespace fiber::python

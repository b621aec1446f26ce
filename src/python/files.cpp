#include <pybind11/stl.h>

#include <optional>
#include <utility>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/python/bindings.hpp"
#include "src/python/errors.hpp"
#include "src/python/fibers.hpp"

namespace fiber::python {
namespace {

FiberFile read_without_lock(const std::string& path, double default_radius) {
  const WithoutPythonLock others_may_run;
  try {
    return read_fibers(path, default_radius);
  } catch (const FileError& error) {
    throw std::invalid_argument(error.what());  // it can be read, so what it holds is wrong
  }
}

/// Warns of all in the file that was not read.
FiberFile read_file(const std::string& path, double default_radius) {
  require_readable(path);
  FiberFile file = read_without_lock(path, default_radius);
  for (const std::string& note : file.notes) {
    if (PyErr_WarnEx(PyExc_UserWarning, (path + ": " + note).c_str(), 1) != 0) {
      throw py::error_already_set();
    }
  }
  return file;
}

std::shared_ptr<Fibers> read(const py::object& path, double default_radius) {
  const std::string name = to_path(path);
  FiberFile file = read_file(name, default_radius);
  if (file.frames.size() != 1) {
    throw std::invalid_argument(name + " holds " + std::to_string(file.frames.size()) +
                                " frames: read_frames() reads them");
  }
  return std::make_shared<Fibers>(std::move(file.frames.front().fibers),
                                  std::move(file.frames.front().names));
}

std::vector<std::pair<std::int64_t, std::shared_ptr<Fibers>>> read_frames(const py::object& path,
                                                                          double default_radius) {
  FiberFile file = read_file(to_path(path), default_radius);
  std::vector<std::pair<std::int64_t, std::shared_ptr<Fibers>>> frames;
  frames.reserve(file.frames.size());
  for (FiberFrame& frame : file.frames) {
    frames.emplace_back(frame.frame,
                        std::make_shared<Fibers>(std::move(frame.fibers), std::move(frame.names)));
  }
  return frames;
}

void write(const py::object& path, const py::object& fibers) {
  const std::string name = to_path(path);
  const Fibers::State state = to_state(fibers, "fibers");
  const FiberNames names = fibers.cast<const Fibers&>().names();
  const WithoutPythonLock others_may_run;
  FiberWriter writer(name, false);
  writer.write({0, *state, names});
  writer.finish();
}

void write_frames(const py::object& path, const py::iterable& frames, const py::object& times) {
  const std::string name = to_path(path);
  std::optional<std::vector<double>> seconds;
  if (!times.is_none()) {
    seconds = to_numbers(times, "times");
  }
  FiberWriter writer(name, true);
  std::size_t count = 0;
  for (const py::handle frame : frames) {
    std::int64_t number = static_cast<std::int64_t>(count);
    py::object fibers = py::reinterpret_borrow<py::object>(frame);
    if (py::isinstance<py::tuple>(frame)) {
      std::tie(number, fibers) = frame.cast<std::pair<std::int64_t, py::object>>();
    }
    const Fibers::State state = to_state(fibers, "a frame");
    const FiberNames names = fibers.cast<const Fibers&>().names();
    if (seconds && count >= seconds->size()) {
      throw std::invalid_argument("there are more frames than times, " +
                                  std::to_string(seconds->size()));
    }
    const WithoutPythonLock others_may_run;
    writer.write({number, *state, names},
                 seconds ? std::make_optional((*seconds)[count]) : std::nullopt);
    ++count;
  }
  if (seconds && count != seconds->size()) {
    throw std::invalid_argument(std::to_string(count) + " frames, but " +
                                std::to_string(seconds->size()) + " times");
  }
  writer.finish();
}

}  // namespace

void bind_files(py::module& module) {
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(std::move(thrown));
    } catch (const FileError& error) {
      // With a number Python makes FileNotFoundError and the like of it.
      const py::object made = error.code() == 0
                                  ? py::handle(PyExc_OSError)(error.what())
                                  : py::handle(PyExc_OSError)(error.code(), error.what());
      PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(made.ptr())), made.ptr());
    }
  });
  module.def("read", &read, py::arg("path"), py::arg("default_radius") = 0.0, R"(
Reads a file of fibres at one moment: CSV or .hair.

CSV has a header with the columns x, y, z and, where there are any, fiber (names), frame and radius,
in any order, separated by commas, semicolons, tabs or blanks. A warning names others.

Parameters
----------
path : str or os.PathLike
default_radius : float [m]
    Of all fibres if the file has no radii.

Returns
-------
Fibers

Raises
------
FileNotFoundError, OSError
    For a file that cannot be read.
ValueError
    For what it should not hold, naming file and line; for several frames; for a name of another
    format, as .h5 or .vtp.
)");
  module.def("read_frames", &read_frames, py::arg("path"), py::arg("default_radius") = 0.0,
             "Reads a file with frames (a CSV file with a column `frame`): a list of "
             "(number, Fibers). A file without numbers has one frame, 0. Raises as ``read()``.");
  module.def("write", &write, py::arg("path"), py::arg("fibers"), R"(
Writes fibres to a file: .hair, .pvd for ParaView, or CSV. Numbers read back as the same, but for
.hair, which has single precision; CSV has names of fibres, too.

Raises
------
FileNotFoundError, OSError
    For a file that cannot be written.
ValueError
    For fibres that the format cannot hold; for a name of another format, as .h5 or .vtp.

>>> import os, tempfile
>>> from fiber_proximity import Fibers, read, write
>>> with tempfile.TemporaryDirectory() as folder:
...     write(os.path.join(folder, "one.csv"), Fibers([[0, 0, 0], [1, 0, 0]], radii=0.25))
...     read(os.path.join(folder, "one.csv")).radii
array([0.25])
)");
  module.def("write_frames", &write_frames, py::arg("path"), py::arg("frames"),
             py::arg("times") = py::none(), R"(
Writes frames to a file, CSV or .pvd, one after the other.

Parameters
----------
path : str or os.PathLike
frames : iterable of Fibers, or of (number, Fibers)
times : (frames,) [s], optional
    Which only .pvd files hold.
)");
}

}  // namespace fiber::python

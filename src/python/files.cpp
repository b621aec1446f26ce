#include <pybind11/stl.h>

#include <optional>
#include <utility>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/io/file_format.hpp"
#include "src/io/one_frame.hpp"
#include "src/python/bindings.hpp"
#include "src/python/errors.hpp"
#include "src/python/fibers.hpp"

namespace fiber::python {
namespace {

FiberFile read_without_lock(const std::string& path, const ReadOptions& options) {
  const WithoutPythonLock others_may_run;
  try {
    return read_fibers(path, options);
  } catch (const FileError& error) {
    throw std::invalid_argument(error.what());  // it can be read, so what it holds is wrong
  }
}

void warn(const std::string& path, const std::vector<std::string>& notes) {
  for (const std::string& note : notes) {
    if (PyErr_WarnEx(PyExc_UserWarning, (path + ": " + note).c_str(), 1) != 0) {
      throw py::error_already_set();
    }
  }
}

/// Warns of all in the file that was not read.
FiberFile read_file(const std::string& path, double default_radius, bool skip_single_points) {
  require_readable(path);
  ReadOptions options(default_radius);
  options.skip_single_points = skip_single_points;
  FiberFile file = read_without_lock(path, options);
  warn(path, file.notes);
  return file;
}

std::shared_ptr<Fibers> read(const py::object& path, double default_radius,
                             bool skip_single_points) {
  const std::string name = to_path(path);
  FiberFile file = read_file(name, default_radius, skip_single_points);
  if (file.frames.size() != 1) {
    throw std::invalid_argument(name + " holds " + std::to_string(file.frames.size()) +
                                " frames: read_frames() reads them");
  }
  return std::make_shared<Fibers>(std::move(file.frames.front().fibers),
                                  std::move(file.frames.front().names));
}

std::vector<std::pair<std::int64_t, std::shared_ptr<Fibers>>> read_frames(const py::object& path,
                                                                          double default_radius,
                                                                          bool skip_single_points) {
  FiberFile file = read_file(to_path(path), default_radius, skip_single_points);
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
  const FiberFrame frame{0, *state, fibers.cast<const Fibers&>().names()};
  {
    const WithoutPythonLock others_may_run;
    FiberWriter writer(name, false);
    writer.write(frame);
    writer.finish();
  }
  if (holds_one_frame(format_of(name))) {
    warn(name, losses(format_of(name), frame));
  }
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
  module.def("read", &read, py::arg("path"), py::arg("default_radius") = 0.0,
             py::arg("skip_single_points") = false, R"(
Reads a file of fibres at one moment: .csv, .hair, .npz, .swc, .tck, .trk, .vtk or
.vtp, as its name ends.

Tractograms (.tck, .trk) are in millimetres, trees of neurons (.swc) in micrometres, and become
metres; .hair, .vtk and .vtp state no unit
and are taken as metres. Lines of VTK that end where they begin are closed, points that they share
are joints, as are branches of .swc. An .npz archive has the arrays points, offsets and, where there
are any, radii, closed and joints. CSV has a header with the columns x, y, z and, where there are any, fiber (names), frame and radius,
in any order, separated by commas, semicolons, tabs or blanks. A warning names others.

Parameters
----------
path : str or os.PathLike
default_radius : float [m]
    Of all fibres if the file has no radii.
skip_single_points : bool
    Leave out fibres of fewer than two points, with a warning of how many there were; without it
    they are an error.

Returns
-------
Fibers

Raises
------
FileNotFoundError, OSError
    For a file that cannot be read.
ValueError
    For what it should not hold, naming file and line; for several frames; for a name of another
    format, as .h5 or .npy.
)");
  module.def("read_frames", &read_frames, py::arg("path"), py::arg("default_radius") = 0.0,
             py::arg("skip_single_points") = false,
             "Reads a file with frames (a CSV file with a column `frame`): a list of "
             "(number, Fibers). A file without numbers has one frame, 0. Raises as ``read()``.");
  module.def("write", &write, py::arg("path"), py::arg("fibers"), R"(
Writes fibres to a file, as its name ends: .csv, .hair, .npz, .tck, .trk, .vtp, or .pvd for
ParaView.
Numbers read back as the same, but for .hair, .tck and .trk, which have single precision; .tck and
.trk are written in millimetres, as those formats are. Only CSV has names of fibres, and .tck has no
radii: a warning tells what is lost.

Raises
------
FileNotFoundError, OSError
    For a file that cannot be written.
ValueError
    For fibres that the format cannot hold; for a name of another format, as .h5 or .npy.

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

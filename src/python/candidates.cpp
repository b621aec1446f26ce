#include "src/python/candidates.hpp"

#include <tbb/parallel_for.h>

#include <iterator>
#include <stdexcept>
#include <string>

#include "src/python/fibers.hpp"
#include "src/text/with_context.hpp"

namespace fiber::python {
namespace {

bool is_sequence_of_fibers(const py::object& object) {
  return !py::isinstance<py::array>(object) && py::isinstance<py::sequence>(object);
}

/// Whether a sequence begins with something that is no number and no array.
bool holds(const py::object& object, bool (*is_wanted)(const py::handle&)) {
  return is_sequence_of_fibers(object) && py::len(object) > 0 &&
         is_wanted(py::object(object[py::int_(0)]));
}

bool is_fibers(const py::handle& item) { return py::isinstance<Fibers>(item); }

bool is_list_of_fibers(const py::handle& item) {
  return holds(py::reinterpret_borrow<py::object>(item), &is_fibers);
}

std::vector<FiberAssembly> copy_states(const py::object& sequence, const std::string& name) {
  std::vector<Fibers::State> states;
  for (const py::handle item : sequence) {
    const std::string place = name + "[" + std::to_string(states.size()) + "]";
    states.push_back(to_state(py::reinterpret_borrow<py::object>(item), place.c_str()));
  }
  const WithoutPythonLock others_may_run;
  std::vector<FiberAssembly> assemblies(states.size());
  tbb::parallel_for(std::size_t{0}, states.size(),
                    [&](std::size_t i) { assemblies[i] = *states[i]; });
  return assemblies;
}

/// Assemblies in a row, each of fibres of as many points.
struct Rows {
  const double* first;
  std::size_t assemblies;
  std::uint32_t fibers;
  std::uint32_t points;  ///< of a fibre
};

std::vector<FiberAssembly> copy_rows(const Rows& rows, const std::vector<double>& radii,
                                     const char* name) {
  std::vector<std::uint32_t> offsets;
  for (std::uint32_t fiber = 0; fiber <= rows.fibers; ++fiber) {
    offsets.push_back(fiber * rows.points);
  }
  const std::size_t each = std::size_t{rows.fibers} * rows.points;
  const WithoutPythonLock others_may_run;
  std::vector<FiberAssembly> assemblies(rows.assemblies);
  const auto copy = [&](std::size_t i) {
    std::vector<Eigen::Vector3d> points;
    copy_points(rows.first + 3 * each * i, each, points);
    with_context(std::string(name) + " " + std::to_string(i),
                 [&] { assemblies[i] = FiberAssembly(std::move(points), offsets, radii); });
  };
  try {
    tbb::parallel_for(std::size_t{0}, rows.assemblies, copy);
  } catch (const std::invalid_argument&) {
    for (std::size_t i = 0; i < rows.assemblies; ++i) {
      copy(i);  // so that the first one is named, whichever thread was faster
    }
    throw;
  }
  return assemblies;
}

/// Reads an array whose last dimensions are ([fibres,] n, 3).
/// @param leading dimensions before them
Rows rows_of(const Doubles& array, Py_ssize_t leading, const char* name, const char* allowed) {
  const Py_ssize_t dimensions = array.ndim();
  const bool has_fibers = dimensions == leading + 3;
  if ((dimensions != leading + 2 && !has_fibers) || array.shape(dimensions - 1) != 3) {
    refuse_shape(array, name, allowed);
  }
  Rows rows{array.data(), 1, 1, 0};
  for (Py_ssize_t i = 0; i < leading; ++i) {
    rows.assemblies *= static_cast<std::size_t>(array.shape(i));
  }
  rows.fibers = has_fibers ? to_index(array.shape(leading), "the number of fibres") : 1;
  rows.points = to_index(array.shape(dimensions - 2), "the number of points");
  if (rows.fibers == 0 || rows.points < 2) {
    refuse_shape(array, name, (std::string(allowed) + " of at least 1 fibre and 2 points").c_str());
  }
  to_index(static_cast<std::int64_t>(rows.fibers) * rows.points, "the number of points");
  return rows;
}

}  // namespace

std::vector<FiberAssembly> to_candidates(const py::object& candidates, const py::object& radii) {
  if (holds(candidates, &is_fibers)) {
    return copy_states(candidates, "candidates");
  }
  const Doubles array = to_doubles(candidates, "candidates");
  if (array.ndim() == 1 && array.size() == 0) {
    return {};
  }
  const Rows rows = rows_of(array, 1, "candidates", "(m, n, 3) or (m, fibres, n, 3)");
  return copy_rows(rows, to_numbers(radii, "radii"), "candidate");
}

std::vector<FiberPath> to_paths(const py::object& motions, const py::object& radii) {
  std::vector<FiberPath> paths;
  if (holds(motions, &is_list_of_fibers)) {
    for (const py::handle motion : motions) {
      const std::string name = "motions[" + std::to_string(paths.size()) + "]";
      paths.push_back(copy_states(py::reinterpret_borrow<py::object>(motion), name));
    }
    return paths;
  }
  const Doubles array = to_doubles(motions, "motions");
  if (array.ndim() == 1 && array.size() == 0) {
    return {};
  }
  const Rows rows = rows_of(array, 2, "motions", "(m, states, n, 3) or (m, states, fibres, n, 3)");
  std::vector<FiberAssembly> states = copy_rows(rows, to_numbers(radii, "radii"), "state");
  const Py_ssize_t length = array.shape(1);
  for (Py_ssize_t i = 0; i < array.shape(0); ++i) {
    const auto begin = std::make_move_iterator(states.begin() + i * length);
    paths.emplace_back(begin, begin + length);
  }
  return paths;
}

}  // namespace fiber::python

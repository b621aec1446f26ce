#include "src/python/fiber_arguments.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "src/python/curves.hpp"

namespace fiber::python {
namespace {

void require_dtype(const py::array& array, const char* kinds, const char* name,
                   const char* allowed) {
  if (std::string(kinds).find(array.dtype().kind()) == std::string::npos && array.size() > 0) {
    throw py::type_error(std::string(name) + " has the dtype " +
                         std::string(py::str(array.dtype())) + ", it must be " + allowed);
  }
}

std::vector<std::uint8_t> to_closed(const py::object& closed, std::size_t fiber_count) {
  const py::array array = to_any_array(closed, "closed");
  require_dtype(array, "biu", "closed", "one of bool");
  if (array.ndim() > 1) {
    refuse_shape(array, "closed", "a bool or (fibres,)");
  }
  const py::array_t<bool, py::array::c_style | py::array::forcecast> flags(array);
  if (array.ndim() == 0) {
    return std::vector<std::uint8_t>(fiber_count, *flags.data() ? 1 : 0);
  }
  return {flags.data(), flags.data() + flags.size()};
}

std::vector<std::int32_t> to_joints(const py::object& object) {
  const py::array array = to_any_array(object, "joints");
  require_dtype(array, "iu", "joints", "one of whole numbers");
  if (array.ndim() != 1) {
    refuse_shape(array, "joints", "(n,)");
  }
  // Numbers beyond int64 would become joints without a sign.
  const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> wide(array);
  const bool is_unsigned = array.dtype().kind() == 'u';
  std::vector<std::int32_t> joints;
  joints.reserve(static_cast<std::size_t>(wide.size()));
  for (Py_ssize_t i = 0; i < wide.size(); ++i) {
    const std::int64_t joint = wide.at(i);
    if (joint > std::numeric_limits<std::int32_t>::max() || (is_unsigned && joint < 0)) {
      throw std::invalid_argument("joints[" + std::to_string(i) + "] is " +
                                  std::to_string(static_cast<std::uint64_t>(joint)) +
                                  ", it must be below 2^31");
    }
    joints.push_back(static_cast<std::int32_t>(std::max<std::int64_t>(joint, -1)));
  }
  return joints;
}

/// Takes joined points from arguments. Warns of numbers of joints that one point alone has.
/// @param closed    a bool for all, (fibres,) of bool, or None
/// @param joints    (n,) of whole numbers, or None
/// @param tolerance [m], or None
FiberTopology to_topology(const py::object& closed, const py::object& joints,
                          const py::object& tolerance, std::size_t fiber_count) {
  FiberTopology topology;
  if (!closed.is_none()) {
    topology.closed = to_closed(closed, fiber_count);
  }
  if (!joints.is_none()) {
    topology.joints = to_joints(joints);
    const std::vector<LonelyJoint> lonely = lonely_joints(topology.joints);
    if (!lonely.empty()) {
      const std::string text = "joints[" + std::to_string(lonely.front().point) + "] is " +
                               std::to_string(lonely.front().joint) +
                               ", which no other point has: it joins nothing";
      if (PyErr_WarnEx(PyExc_UserWarning, text.c_str(), 1) != 0) {
        throw py::error_already_set();
      }
    }
  }
  if (!tolerance.is_none()) {
    topology.joint_tolerance = tolerance.cast<double>();
  }
  return topology;
}

}  // namespace

FiberAssembly make_fibers(const py::object& points, const py::object& offsets,
                          const py::object& radii, const py::object& closed,
                          const py::object& joints, const py::object& joint_tolerance) {
  const auto topology_of = [&](std::size_t offset_count) {
    return to_topology(closed, joints, joint_tolerance, std::max<std::size_t>(offset_count, 1) - 1);
  };
  if (is_list_of_curves(points)) {
    if (!offsets.is_none()) {
      throw std::invalid_argument("points is a list of curves, which needs no offsets");
    }
    Curves curves = to_curves(points, "points");
    std::vector<double> thickness = to_radii(radii, curves.offsets);
    const FiberTopology topology = topology_of(curves.offsets.size());
    const WithoutPythonLock others_may_run;
    return FiberAssembly(std::move(curves.points), std::move(curves.offsets), std::move(thickness),
                         topology);
  }
  const Doubles array = to_doubles(points, "points");
  const bool is_stack = array.ndim() == 3 && offsets.is_none();
  if (!is_stack && array.ndim() != 2) {
    refuse_shape(array, "points", "(n, 3), or (fibres, n, 3) without offsets");
  }
  if (array.shape(array.ndim() - 1) != 3) {
    refuse_shape(array, "points", "(n, 3), or (fibres, n, 3) without offsets");
  }
  std::vector<std::uint32_t> begins;
  if (offsets.is_none()) {
    const Py_ssize_t length = is_stack ? array.shape(1) : array.shape(0);
    // One fibre without points is enough to be refused.
    const Py_ssize_t most = length == 0 ? 1 : std::numeric_limits<Py_ssize_t>::max();
    const Py_ssize_t fibers = is_stack ? std::min(array.shape(0), most) : 1;
    for (Py_ssize_t fiber = 0; fiber <= fibers; ++fiber) {
      begins.push_back(to_index(fiber * length, "the number of points"));
    }
  } else {
    begins = to_indices(offsets, "offsets");
  }
  std::vector<double> thickness = to_numbers(radii, "radii");
  const FiberTopology topology = topology_of(begins.size());
  const double* rows = array.data();
  const auto count = static_cast<std::size_t>(array.size() / 3);
  const WithoutPythonLock others_may_run;
  std::vector<Eigen::Vector3d> copied;
  copy_points(rows, count, copied);
  return FiberAssembly(std::move(copied), std::move(begins), std::move(thickness), topology);
}

}  // namespace fiber::python

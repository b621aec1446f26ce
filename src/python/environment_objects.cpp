#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "src/environment/obstacle_parts.hpp"
#include "src/python/environment.hpp"
#include "src/python/errors.hpp"

namespace fiber::python {
namespace {

Eigen::Isometry3d to_isometry(const Doubles& matrix, const char* name) {
  Eigen::Isometry3d pose;
  for (Py_ssize_t row = 0; row < 4; ++row) {
    for (Py_ssize_t column = 0; column < 4; ++column) {
      pose.matrix()(row, column) = matrix.at(row, column);
    }
  }
  if (pose.matrix().row(3) != Eigen::RowVector4d(0.0, 0.0, 0.0, 1.0)) {
    throw std::invalid_argument(std::string(name) + " has a last row that is not 0, 0, 0, 1");
  }
  return pose;
}

void add(SharedWorld& world, const std::string& name, Shape shape, const py::object& pose) {
  ObjectChange change;
  change.object.name = name;
  change.object.pose = to_pose(pose);
  change.object.shapes.push_back({std::move(shape), Eigen::Isometry3d::Identity()});
  const WithoutPythonLock others_may_run;
  world.apply({change});
}

std::shared_ptr<const TriangleMesh> to_mesh(const py::object& mesh, const py::object& faces) {
  const bool has_arrays = faces.is_none();
  if (has_arrays && (!py::hasattr(mesh, "vertices") || !py::hasattr(mesh, "faces"))) {
    throw py::type_error("mesh is a " + std::string(py::str(mesh.get_type())) +
                         ", it must have vertices and faces, or be (n, 3) with faces beside it");
  }
  std::vector<Eigen::Vector3d> vertices =
      to_points(has_arrays ? py::object(mesh.attr("vertices")) : mesh, "vertices");
  const py::array corners =
      to_any_array(has_arrays ? py::object(mesh.attr("faces")) : faces, "faces");
  if (corners.ndim() != 2 || corners.shape(1) != 3) {
    refuse_shape(corners, "faces", "(m, 3)");
  }
  const std::vector<std::uint32_t> indices = to_indices(corners.attr("reshape")(-1), "faces");
  std::vector<TriangleMesh::Triangle> triangles;
  triangles.reserve(indices.size() / 3);
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
  }
  const WithoutPythonLock others_may_run;
  return std::make_shared<const TriangleMesh>(std::move(vertices), std::move(triangles));
}

}  // namespace

Eigen::Isometry3d to_pose(const py::object& object, const char* name) {
  if (object.is_none()) {
    return Eigen::Isometry3d::Identity();
  }
  const Doubles array = to_doubles(object, name);
  if (array.ndim() == 2 && array.shape(0) == 4 && array.shape(1) == 4) {
    return to_isometry(array, name);
  }
  if (array.ndim() != 1 || (array.shape(0) != 3 && array.shape(0) != 7)) {
    refuse_shape(array, name, "(4, 4), (3,) or (7,)");
  }
  const Eigen::Vector3d position(array.at(0), array.at(1), array.at(2));
  const bool is_turned = array.shape(0) == 7;
  return make_pose(
      position, is_turned ? Eigen::Quaterniond(array.at(6), array.at(3), array.at(4), array.at(5))
                          : Eigen::Quaterniond::Identity());
}

void bind_shapes(py::class_<SharedWorld, std::shared_ptr<SharedWorld>>& environment) {
  const auto none = py::none();
  environment
      .def(
          "add_box",
          [](SharedWorld& world, const std::string& name, const py::object& size,
             const py::object& pose) { add(world, name, BoxShape{to_vector(size, "size")}, pose); },
          py::arg("name"), py::arg("size"), py::arg("pose") = none,
          "A box of these edges (3,) [m] around its pose.")
      .def(
          "add_sphere",
          [](SharedWorld& world, const std::string& name, double radius, const py::object& pose) {
            add(world, name, SphereShape{radius}, pose);
          },
          py::arg("name"), py::arg("radius"), py::arg("pose") = none, "A sphere [m].")
      .def(
          "add_cylinder",
          [](SharedWorld& world, const std::string& name, double radius, double height,
             const py::object& pose) {
            add(world, name, CylinderShape{radius, height}, pose);
          },
          py::arg("name"), py::arg("radius"), py::arg("height"), py::arg("pose") = none,
          "A cylinder along z, from -height / 2 to height / 2 [m].")
      .def(
          "add_cone",
          [](SharedWorld& world, const std::string& name, double radius, double height,
             const py::object& pose) {
            add(world, name, ConeShape{radius, height}, pose);
          },
          py::arg("name"), py::arg("radius"), py::arg("height"), py::arg("pose") = none,
          "A cone: its base at z = -height / 2, its apex at z = height / 2 [m].")
      .def(
          "add_capsule",
          [](SharedWorld& world, const std::string& name, double radius, double length,
             const py::object& pose) {
            add(world, name, CapsuleShape{radius, length}, pose);
          },
          py::arg("name"), py::arg("radius"), py::arg("length"), py::arg("pose") = none,
          "All points within the radius of a segment along z of this length [m].")
      .def(
          "add_plane",
          [](SharedWorld& world, const std::string& name, const py::object& normal, double offset) {
            const Eigen::Vector3d n = to_vector(normal, "normal");
            add(world, name, make_plane({n.x(), n.y(), n.z(), -offset}), py::none());
          },
          py::arg("name"), py::arg("normal"), py::arg("offset") = 0.0,
          "A sheet that can be touched from both sides: all points p with normal . p = offset.")
      .def(
          "add_half_space",
          [](SharedWorld& world, const std::string& name, const py::object& normal, double offset) {
            const Eigen::Vector3d n = to_vector(normal, "normal");
            add(world, name, make_half_space({n.x(), n.y(), n.z(), -offset}), py::none());
          },
          py::arg("name"), py::arg("normal"), py::arg("offset") = 0.0,
          "Solid where normal . p <= offset: a floor has the normal (0, 0, 1).")
      .def(
          "add_mesh",
          [](SharedWorld& world, const std::string& name, const py::object& mesh,
             const py::object& faces,
             const py::object& pose) { add(world, name, to_mesh(mesh, faces), pose); },
          py::arg("name"), py::arg("mesh"), py::arg("faces") = none, py::arg("pose") = none, R"(
Triangles: of an object with `vertices` and `faces`, as trimesh has, or vertices (n, 3) [m] with
faces (m, 3) beside them, counter-clockwise from outside.

A mesh whose every edge joins two triangles is solid, any other is a sheet.
)")
      .def(
          "add_mesh_file",
          [](SharedWorld& world, const std::string& name, const py::object& file,
             const py::object& scale, const py::object& pose) {
            const std::string path = to_path(file);
            require_readable(path);
            const Eigen::Vector3d factors = to_vector(scale, "scale");
            std::shared_ptr<const TriangleMesh> mesh;
            {
              const WithoutPythonLock others_may_run;
              mesh = read_mesh_file(path, factors);
            }
            add(world, name, mesh, pose);
          },
          py::arg("name"), py::arg("path"), py::arg("scale") = py::make_tuple(1.0, 1.0, 1.0),
          py::arg("pose") = none, "The mesh of a file, in any format that assimp reads.");
}

}  // namespace fiber::python

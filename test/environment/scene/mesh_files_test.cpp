#include "test/support/mesh_files.hpp"

#include <gtest/gtest.h>

#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "test/support/error_of.hpp"
#include "test/support/not_finite.hpp"
#include "test/support/temporary_directory.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;
using test::error_of;
using test::nan;
using test_meshes::write;

const Vector3d unscaled = Vector3d::Ones();

/// Six times the volume within the surface [m³], negative if it is inside out.
double sixfold_volume(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (const TriangleMesh::Triangle& triangle : mesh.triangles()) {
    const auto vertex = [&](int i) { return mesh.vertices()[triangle[i]]; };
    volume += vertex(0).dot(vertex(1).cross(vertex(2)));
  }
  return volume;
}

class MeshFiles : public ::testing::Test {
 protected:
  MeshFiles() : file_(path("tetrahedron.obj")) { write(file_, test_meshes::tetrahedron); }

  std::string path(const std::string& name) const { return folder_.path(name); }

  /// The error about a file of this name and content.
  std::string error(const std::string& name, const std::string& content) const {
    write(path(name), content);
    return error_of([&] { read_mesh_file(path(name), unscaled); });
  }

  const test::TemporaryDirectory folder_;
  const std::string file_;
};

TEST_F(MeshFiles, AreReadAndScaled) {
  for (const Vector3d& scale : {Vector3d(1, 1, 1), Vector3d(2, 3, 4), Vector3d(-1, 1, 2),
                                Vector3d(-1, -1, 1), Vector3d(-2, -1, -1)}) {
    const auto mesh = read_mesh_file(file_, scale);
    EXPECT_EQ(mesh->triangles().size(), 4U);
    EXPECT_DOUBLE_EQ(sixfold_volume(*mesh), std::abs(scale.prod()));
    EXPECT_TRUE(mesh->is_closed());
  }
}

/// A file of COLLADA says that its unit is a decimetre and y is up: what is in it counts, as it
/// does for rviz. Its node is moved by 1 along x.
TEST_F(MeshFiles, NodesArePlacedAndTheRootIsNot) {
  write(
      path("triangle.DAE"),
      "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" "
      "version=\"1.4.1\"><asset><unit meter=\"0.1\"/><up_axis>Y_UP</up_axis></asset>"
      "<library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"a\" "
      "count=\"9\">0 0 0 1 0 0 0 2 0</float_array><technique_common><accessor source=\"#a\" "
      "count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" "
      "type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor></technique_common></source>"
      "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices><triangles "
      "count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles>"
      "</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\">"
      "<node id=\"outer\"><node id=\"n\"><translate>1 0 0</translate><instance_geometry "
      "url=\"#g\"/></node></node><node id=\"m\"><instance_geometry url=\"#g\"/></node>"
      "</visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene>"
      "</COLLADA>\n");
  const auto mesh = read_mesh_file(path("triangle.DAE"), unscaled);
  EXPECT_EQ(mesh->triangles().size(), 2U);
  EXPECT_EQ(mesh->box().min(), Vector3d(0, 0, 0));
  EXPECT_EQ(mesh->box().max(), Vector3d(2, 2, 0));
}

TEST_F(MeshFiles, AreNamedByPathsAndUrls) {
  const MeshSource here = mesh_files(path(""));
  for (const std::string& resource : {std::string("tetrahedron.obj"), file_, "file://" + file_,
                                      std::string("./tetrahedron.obj")}) {
    EXPECT_EQ(here(resource, unscaled)->triangles().size(), 4U) << resource;
  }
  EXPECT_EQ(error_of([&] { here("a.stl", unscaled); }),
            "mesh 'a.stl': there is no file '" + path("a.stl") + "'");
  EXPECT_EQ(error_of([&] { here("package://any/a.stl", unscaled); }),
            "mesh 'package://any/a.stl': packages are found with ROS only, it must be "
            "file:///PATH or a path");
}

TEST_F(MeshFiles, WhatIsNoMeshIsRefused) {
  for (const auto& [name, content] :
       {std::make_pair("text.stl", "this is no mesh"), std::make_pair("empty.stl", ""),
        std::make_pair("points.obj", "v 0 0 0\nv 1 0 0\n")}) {
    EXPECT_EQ(error(name, content), "it holds no mesh in a format that assimp reads") << name;
  }
  EXPECT_EQ(error_of([&] { read_mesh_file(path(""), unscaled); }),
            "there is no file '" + path("") + "'");
}

TEST_F(MeshFiles, WhatAssimpFailsOnCostsOnlyItself) {
  const std::string header =
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_h";
  EXPECT_NE(error("endless.ply", "ply\nformat binary_little_endian 1.0\n" + header), "no error");
  EXPECT_NE(error("crash.ply", "ply\nformat ascii 1.0\n" + header +
                                   "eader\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2000000000\n"),
            "no error");
  EXPECT_EQ(read_mesh_file(file_, unscaled)->triangles().size(), 4U);
}

TEST_F(MeshFiles, GiantFilesAreRefusedUnread) {
  write(path("giant.stl"), "solid");
  std::filesystem::resize_file(path("giant.stl"), max_mesh_file_size + 1);
  EXPECT_EQ(error_of([&] { read_mesh_file(path("giant.stl"), unscaled); }),
            "the file has 100000001 bytes, it may have at most 100000000");
}

TEST_F(MeshFiles, BadScalesAreRefused) {
  const auto error_with = [this](const Vector3d& scale) {
    return error_of([&] { read_mesh_file(file_, scale); });
  };
  EXPECT_EQ(error_with({1, 0, 1}), "scale is (1, 0, 1), its numbers must be finite and not 0");
  EXPECT_EQ(error_with({1, nan, 1}), "scale is (1, nan, 1), its numbers must be finite and not 0");
}

}  // namespace
}  // namespace fiber

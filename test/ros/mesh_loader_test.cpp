#include "fiber_proximity/ros/mesh_loader.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "fiber_proximity/ros/conversions.hpp"
#include "fiber_proximity/ros/obstacle_shapes.hpp"
#include "ros/mesh_files.hpp"
#include "support/error_of.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;
using fiber::test::error_of;
using test_meshes::Package;
using test_meshes::write;

const Vector3d unscaled = Vector3d::Ones();

/// Six times the volume within the surface [m³], negative if it is inside out.
double sixfold_volume(const shape_msgs::Mesh& mesh) {
  double volume = 0.0;
  for (const shape_msgs::MeshTriangle& triangle : mesh.triangles) {
    const auto vertex = [&](int i) { return to_vector(mesh.vertices[triangle.vertex_indices[i]]); };
    volume += vertex(0).dot(vertex(1).cross(vertex(2)));
  }
  return volume;
}

TEST(MeshLoader, MeshesOfPackagesAreReadAndScaled) {
  const Package package;
  const std::string resource = "package://test_meshes/meshes/tetrahedron.obj";
  for (const Vector3d& scale : {Vector3d(1, 1, 1), Vector3d(2, 3, 4), Vector3d(-1, 1, 2),
                                Vector3d(-1, -1, 1), Vector3d(-2, -1, -1)}) {
    const shape_msgs::Mesh mesh = MeshLoader().load(resource, scale);
    EXPECT_EQ(mesh.triangles.size(), 4U);
    EXPECT_DOUBLE_EQ(sixfold_volume(mesh), std::abs(scale.prod()));
    const auto shape = std::get<std::shared_ptr<const fiber::TriangleMesh>>(to_shape(mesh));
    EXPECT_TRUE(shape->is_closed());
  }
}

TEST(MeshLoader, FilesAreReadFromTheFoldersThatAreConfigured) {
  const Package package;
  const std::string file = package.file("meshes/tetrahedron.obj");
  const MeshLoader loader({package.outside("")});
  EXPECT_EQ(loader.load("file://" + file, unscaled).triangles.size(), 4U);
  const std::string refusal =
      "mesh 'file://" + file +
      "': it must be in a package, package://NAME/PATH, or in a folder of the parameter "
      "mesh_folders, file:///PATH";
  EXPECT_EQ(error_of([&] { MeshLoader().load("file://" + file, unscaled); }), refusal);
  write(package.outside("other/readme"), "");
  const MeshLoader elsewhere({package.outside("other")});
  EXPECT_EQ(error_of([&] { elsewhere.load("file://" + file, unscaled); }), refusal);
  // A folder's name that begins like that of another is another folder.
  write(package.outside("test/readme"), "");
  const MeshLoader prefix({package.outside("test")});
  EXPECT_EQ(error_of([&] { prefix.load("file://" + file, unscaled); }), refusal);
}

TEST(MeshLoader, NothingLeadsOutOfPackagesAndFolders) {
  const Package package;
  write(package.outside("secret.obj"), test_meshes::tetrahedron);
  std::filesystem::create_symlink(package.outside("secret.obj"), package.file("link.obj"));
  const auto error_for = [](const MeshLoader& loader, const std::string& resource) {
    return error_of([&] { loader.load(resource, unscaled); });
  };
  for (const char* path : {"../secret.obj", "meshes/../../secret.obj", "link.obj"}) {
    const std::string error = error_for(MeshLoader(), std::string("package://test_meshes/") + path);
    EXPECT_NE(error.find("secret.obj', outside of the package"), std::string::npos) << error;
  }
  EXPECT_NE(error_for(MeshLoader(), "package://test_meshes/%2e%2e/secret.obj").find("no file"),
            std::string::npos);
  const MeshLoader folder({package.file("meshes")});
  for (const char* path : {"meshes/../link.obj", "../secret.obj", "link.obj"}) {
    const std::string error = error_for(folder, "file://" + package.file(path));
    EXPECT_NE(error.find("it must be in a package"), std::string::npos) << error;
  }
}

TEST(MeshLoader, OtherSchemesAreRefused) {
  for (const char* resource : {"http://localhost/a.stl", "/etc/passwd", "a.stl", "", "File:///a"}) {
    EXPECT_EQ(error_of([&] { MeshLoader({"/"}).load(resource, unscaled); }),
              std::string("mesh '") + resource +
                  "': it must be in a package, package://NAME/PATH, or in a folder of the "
                  "parameter mesh_folders, file:///PATH");
  }
}

TEST(MeshLoader, WhatIsNotThereIsRefused) {
  const Package package;
  const auto error_for = [](const std::string& resource) {
    return error_of([&] { MeshLoader().load(resource, unscaled); });
  };
  EXPECT_EQ(error_for("package://no_such_package/a.stl"),
            "mesh 'package://no_such_package/a.stl': there is no package 'no_such_package', it "
            "must be package://NAME/PATH with a package ROS finds");
  EXPECT_NE(error_for("package://test_meshes").find("package://NAME/PATH"), std::string::npos);
  EXPECT_NE(error_for("package:///a.stl").find("no package ''"), std::string::npos);
  EXPECT_NE(error_for("package://test_meshes/a.stl").find("there is no file"), std::string::npos);
  EXPECT_NE(error_for("package://test_meshes/meshes").find("there is no file"), std::string::npos);
}

TEST(MeshLoader, WhatIsNoMeshIsRefused) {
  const Package package;
  write(package.file("text.stl"), "this is no mesh");
  write(package.file("empty.stl"), "");
  write(package.file("points.obj"), "v 0 0 0\nv 1 0 0\n");
  for (const char* name : {"text.stl", "empty.stl", "points.obj"}) {
    const std::string resource = std::string("package://test_meshes/") + name;
    const std::string error = error_of([&] { MeshLoader().load(resource, unscaled); });
    EXPECT_EQ(error.rfind("mesh '" + resource + "': ", 0), 0U) << error;
    EXPECT_NE(error.find("holds no mesh"), std::string::npos) << error;
  }
}

TEST(MeshLoader, WhatAssimpFailsOnCostsOnlyItself) {
  const Package package;
  const std::string header =
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_h";
  write(package.file("endless.ply"), "ply\nformat binary_little_endian 1.0\n" + header);
  write(package.file("crash.ply"),
        "ply\nformat ascii 1.0\n" + header + "eader\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2000000000\n");
  for (const char* name : {"endless.ply", "crash.ply"}) {
    const std::string resource = std::string("package://test_meshes/") + name;
    const std::string error = error_of([&] { MeshLoader().load(resource, unscaled); });
    EXPECT_EQ(error.rfind("mesh '" + resource + "': ", 0), 0U) << error;
  }
  EXPECT_EQ(
      MeshLoader().load("package://test_meshes/meshes/tetrahedron.obj", unscaled).triangles.size(),
      4U);
}

TEST(MeshLoader, GiantFilesAreRefusedUnread) {
  const Package package;
  write(package.file("giant.stl"), "solid");
  std::filesystem::resize_file(package.file("giant.stl"), MeshLoader::largest_file + 1);
  EXPECT_EQ(error_of([] { MeshLoader().load("package://test_meshes/giant.stl", unscaled); }),
            "mesh 'package://test_meshes/giant.stl': the file has 100000001 bytes, it may have at "
            "most 100000000");
}

TEST(MeshLoader, BadScalesAndFoldersAreRefused) {
  const Package package;
  const std::string resource = "package://test_meshes/meshes/tetrahedron.obj";
  EXPECT_EQ(error_of([&] { MeshLoader().load(resource, Vector3d(1, 0, 1)); }),
            "mesh '" + resource + "': scale is (1, 0, 1), its numbers must be finite and not 0");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error_of([&] { MeshLoader().load(resource, Vector3d(1, nan, 1)); }),
            "mesh '" + resource + "': scale is (1, nan, 1), its numbers must be finite and not 0");
  for (const std::string folder : {"meshes", "/no/such/folder"}) {
    EXPECT_EQ(
        error_of([&] { MeshLoader({folder}); }),
        "folder of meshes '" + folder + "' is not there, it must be an absolute path of a folder");
  }
}

}  // namespace
}  // namespace fiber_proximity_ros

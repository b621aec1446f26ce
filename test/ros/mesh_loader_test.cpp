#include "src/ros/environment/mesh_loader.hpp"

#include <gtest/gtest.h>

#include "test/ros/mesh_files.hpp"
#include "test/support/error_of.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;
using fiber::test::error_of;
using test_meshes::Package;
using test_meshes::write;

const Vector3d unscaled = Vector3d::Ones();

TEST(MeshLoader, MeshesOfPackagesAreReadAndScaled) {
  const Package package;
  const auto mesh = MeshLoader()("package://test_meshes/meshes/tetrahedron.obj", {1, 2, 3});
  EXPECT_EQ(mesh->triangles().size(), 4U);
  EXPECT_EQ(mesh->box().max(), Vector3d(1, 2, 3));
}

TEST(MeshLoader, FilesAreReadFromTheFoldersThatAreConfigured) {
  const Package package;
  const std::string file = package.file("meshes/tetrahedron.obj");
  const MeshLoader loader({package.outside("")});
  EXPECT_EQ(loader("file://" + file, unscaled)->triangles().size(), 4U);
  const std::string refusal =
      "mesh 'file://" + file +
      "': it must be in a package, package://NAME/PATH, or in a folder of the parameter "
      "mesh_folders, file:///PATH";
  EXPECT_EQ(error_of([&] { MeshLoader()("file://" + file, unscaled); }), refusal);
  write(package.outside("other/readme"), "");
  const MeshLoader elsewhere({package.outside("other")});
  EXPECT_EQ(error_of([&] { elsewhere("file://" + file, unscaled); }), refusal);
  // A folder's name that begins like that of another is another folder.
  write(package.outside("test/readme"), "");
  const MeshLoader prefix({package.outside("test")});
  EXPECT_EQ(error_of([&] { prefix("file://" + file, unscaled); }), refusal);
}

TEST(MeshLoader, NothingLeadsOutOfPackagesAndFolders) {
  const Package package;
  write(package.outside("secret.obj"), test_meshes::tetrahedron);
  std::filesystem::create_symlink(package.outside("secret.obj"), package.file("link.obj"));
  const auto error_for = [](const MeshLoader& loader, const std::string& resource) {
    return error_of([&] { loader(resource, unscaled); });
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
    EXPECT_EQ(error_of([&] { MeshLoader({"/"})(resource, unscaled); }),
              std::string("mesh '") + resource +
                  "': it must be in a package, package://NAME/PATH, or in a folder of the "
                  "parameter mesh_folders, file:///PATH");
  }
}

TEST(MeshLoader, WhatIsNotThereIsRefused) {
  const Package package;
  const auto error_for = [](const std::string& resource) {
    return error_of([&] { MeshLoader()(resource, unscaled); });
  };
  EXPECT_EQ(error_for("package://no_such_package/a.stl"),
            "mesh 'package://no_such_package/a.stl': there is no package 'no_such_package', it "
            "must be package://NAME/PATH with a package ROS finds");
  EXPECT_NE(error_for("package://test_meshes").find("package://NAME/PATH"), std::string::npos);
  EXPECT_NE(error_for("package:///a.stl").find("no package ''"), std::string::npos);
  EXPECT_NE(error_for("package://test_meshes/a.stl").find("there is no file"), std::string::npos);
  EXPECT_NE(error_for("package://test_meshes/meshes").find("there is no file"), std::string::npos);
}

TEST(MeshLoader, WhatIsWrongWithAFileIsToldOfTheResource) {
  const Package package;
  const std::string resource = "package://test_meshes/meshes/tetrahedron.obj";
  EXPECT_EQ(error_of([&] { MeshLoader()(resource, Vector3d(1, 0, 1)); }),
            "mesh '" + resource + "': scale is (1, 0, 1), its numbers must be finite and not 0");
  write(package.file("text.stl"), "this is no mesh");
  EXPECT_EQ(
      error_of([&] { MeshLoader()("package://test_meshes/text.stl", unscaled); }),
      "mesh 'package://test_meshes/text.stl': it holds no mesh in a format that assimp reads");
}

TEST(MeshLoader, FoldersThatAreNotThereAreRefused) {
  for (const std::string folder : {"meshes", "/no/such/folder"}) {
    EXPECT_EQ(
        error_of([&] { MeshLoader({folder}); }),
        "folder of meshes '" + folder + "' is not there, it must be an absolute path of a folder");
  }
}

}  // namespace
}  // namespace fiber_proximity_ros

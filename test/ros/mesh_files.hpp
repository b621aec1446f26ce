#pragma once

#include <cstdlib>
#include <string>

#include "test/support/mesh_files.hpp"
#include "test/support/temporary_directory.hpp"

namespace test_meshes {

/// A folder with the ROS package `test_meshes`, which has meshes/tetrahedron.obj; ROS finds it as
/// long as this lives.
class Package {
 public:
  Package() {
    write(folder_.path("test_meshes/package.xml"),
          "<package format=\"2\"><name>test_meshes</name><version>0.0.0</version>"
          "<description>Meshes of a test.</description>"
          "<maintainer email=\"nobody@localhost\">nobody</maintainer>"
          "<license>BSD</license></package>");
    write(file("meshes/tetrahedron.obj"), tetrahedron);
    const char* path = std::getenv("ROS_PACKAGE_PATH");
    old_path_ = path != nullptr ? path : "";
    setenv("ROS_PACKAGE_PATH", (folder_.path("") + ":" + old_path_).c_str(), 1);
  }
  ~Package() { setenv("ROS_PACKAGE_PATH", old_path_.c_str(), 1); }
  Package(const Package&) = delete;
  Package& operator=(const Package&) = delete;

  /// Path of a file of the package.
  std::string file(const std::string& name) const { return folder_.path("test_meshes/" + name); }

  /// Path of a file beside the package.
  std::string outside(const std::string& name) const { return folder_.path(name); }

 private:
  fiber::test::TemporaryDirectory folder_;
  std::string old_path_;
};

}  // namespace test_meshes

#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "support/temporary_directory.hpp"

/// Files for tests about meshes.
namespace test_meshes {

/// A tetrahedron at the origin with legs of 1 m, as OBJ.
inline const char* const tetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

inline void write(const std::string& file, const std::string& content) {
  std::filesystem::create_directories(std::filesystem::path(file).parent_path());
  std::ofstream(file, std::ios::binary) << content;
}

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

#pragma once

#include <filesystem>
#include <fstream>
#include <string>

/// Files for tests about meshes.
namespace test_meshes {

/// A tetrahedron at the origin with legs of 1 m, as OBJ.
inline const char* const tetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

inline void write(const std::string& file, const std::string& content) {
  std::filesystem::create_directories(std::filesystem::path(file).parent_path());
  std::ofstream(file, std::ios::binary) << content;
}

}  // namespace test_meshes

#include "fiber_proximity/environment/scene/mesh_files.hpp"

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "src/environment/scene/parse_mesh.hpp"
#include "src/text/quote.hpp"
#include "src/text/with_context.hpp"

namespace fiber {
namespace {

using std::filesystem::path;

std::string read_bytes(const path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw std::invalid_argument("there is no file " + quote(file.string()));
  }
  const std::uintmax_t size = std::filesystem::file_size(file);
  if (size > largest_mesh_file) {
    throw std::invalid_argument("the file has " + std::to_string(size) +
                                " bytes, it may have at most " + std::to_string(largest_mesh_file));
  }
  std::string bytes(size, '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(bytes.data(), static_cast<std::streamsize>(size))) {
    throw std::invalid_argument("the file " + quote(file.string()) + " cannot be read");
  }
  return bytes;
}

void check_scale(const Eigen::Vector3d& scale) {
  if (!(scale.allFinite() && (scale.array() != 0.0).all())) {
    std::ostringstream message;
    message << "scale is (" << scale.x() << ", " << scale.y() << ", " << scale.z()
            << "), its numbers must be finite and not 0";
    throw std::invalid_argument(message.str());
  }
}

}  // namespace

std::shared_ptr<const TriangleMesh> read_mesh_file(const path& file, const Eigen::Vector3d& scale) {
  check_scale(scale);
  ParsedMesh mesh = parse_mesh(read_bytes(file), file.filename().string());
  for (Eigen::Vector3d& vertex : mesh.vertices) {
    vertex = scale.cwiseProduct(vertex);
  }
  const bool is_mirrored = (scale.array() < 0.0).count() % 2 == 1;
  if (is_mirrored) {
    for (TriangleMesh::Triangle& triangle : mesh.triangles) {
      std::swap(triangle[1], triangle[2]);
    }
  }
  return std::make_shared<const TriangleMesh>(std::move(mesh.vertices), std::move(mesh.triangles));
}

MeshSource mesh_files(const path& folder) {
  return [folder](const std::string& resource, const Eigen::Vector3d& scale) {
    return with_context("mesh " + quote(resource), [&] {
      const std::string scheme = "file://";
      if (resource.rfind("package://", 0) == 0) {
        throw std::invalid_argument(
            "packages are found with ROS only, it must be file:///PATH or a path");
      }
      const bool has_scheme = resource.rfind(scheme, 0) == 0;
      return read_mesh_file(folder / resource.substr(has_scheme ? scheme.size() : 0), scale);
    });
  };
}

}  // namespace fiber

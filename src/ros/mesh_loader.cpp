#include "fiber_proximity/ros/mesh_loader.hpp"

#include <ros/package.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "fiber_proximity/ros/conversions.hpp"
#include "fiber_proximity/ros/parse_mesh.hpp"
#include "fiber_proximity/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

using std::filesystem::path;

const std::string package_scheme = "package://";
const std::string file_scheme = "file://";

bool has_prefix(const std::string& text, const std::string& prefix) {
  return text.rfind(prefix, 0) == 0;
}

bool lies_in(const path& file, const path& folder) {
  const auto [rest, unused] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return rest == folder.end();
}

/// All links followed; what does not exist is taken as it is written.
path real_path(const path& written) {
  std::error_code error;
  path real = std::filesystem::weakly_canonical(written, error);
  if (error) {
    throw std::invalid_argument(fiber::quote(written.string()) + ": " + error.message());
  }
  return real;
}

path resolve_in_package(const std::string& resource) {
  const std::size_t slash = resource.find('/', package_scheme.size());
  const std::string package = resource.substr(package_scheme.size(), slash - package_scheme.size());
  const std::string folder = package.empty() ? "" : ros::package::getPath(package);
  if (folder.empty() || slash == std::string::npos) {
    throw std::invalid_argument("there is no package " + fiber::quote(package) +
                                ", it must be package://NAME/PATH with a package ROS finds");
  }
  path file = real_path(folder + resource.substr(slash));
  if (!lies_in(file, real_path(folder))) {
    throw std::invalid_argument("it leads to " + fiber::quote(file.string()) +
                                ", outside of the package");
  }
  return file;
}

std::string read(const path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    throw std::invalid_argument("there is no file " + fiber::quote(file.string()));
  }
  const std::uintmax_t size = std::filesystem::file_size(file);
  if (size > MeshLoader::largest_file) {
    throw std::invalid_argument("the file has " + std::to_string(size) +
                                " bytes, it may have at most " +
                                std::to_string(MeshLoader::largest_file));
  }
  std::string bytes(size, '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(bytes.data(), static_cast<std::streamsize>(size))) {
    throw std::invalid_argument("the file " + fiber::quote(file.string()) + " cannot be read");
  }
  return bytes;
}

shape_msgs::Mesh to_mesh(const ParsedMesh& mesh, const Eigen::Vector3d& scale) {
  shape_msgs::Mesh message;
  message.vertices.reserve(mesh.coordinates.size() / 3);
  for (std::size_t i = 0; i < mesh.coordinates.size(); i += 3) {
    const Eigen::Map<const Eigen::Vector3d> vertex(mesh.coordinates.data() + i);
    message.vertices.push_back(to_message(Eigen::Vector3d(scale.cwiseProduct(vertex))));
  }
  const bool mirrored = (scale.array() < 0.0).count() % 2 == 1;
  message.triangles.resize(mesh.corners.size() / 3);
  for (std::size_t i = 0; i < message.triangles.size(); ++i) {
    auto& triangle = message.triangles[i].vertex_indices;
    std::copy_n(mesh.corners.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, triangle.begin());
    if (mirrored) {
      std::swap(triangle[1], triangle[2]);
    }
  }
  return message;
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

MeshLoader::MeshLoader(const std::vector<std::string>& folders) {
  for (const std::string& folder : folders) {
    if (!path(folder).is_absolute() || !std::filesystem::is_directory(folder)) {
      throw std::invalid_argument("folder of meshes " + fiber::quote(folder) +
                                  " is not there, it must be an absolute path of a folder");
    }
    folders_.push_back(real_path(folder));
  }
}

shape_msgs::Mesh MeshLoader::load(const std::string& resource, const Eigen::Vector3d& scale) const {
  try {
    check_scale(scale);
    const path file = resolve(resource);
    return to_mesh(parse_mesh(read(file), file.filename().string()), scale);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("mesh " + fiber::quote(resource) + ": " + error.what());
  }
}

path MeshLoader::resolve(const std::string& resource) const {
  if (has_prefix(resource, package_scheme)) {
    return resolve_in_package(resource);
  }
  if (has_prefix(resource, file_scheme)) {
    path file = real_path(resource.substr(file_scheme.size()));
    if (std::any_of(folders_.begin(), folders_.end(),
                    [&file](const path& folder) { return lies_in(file, folder); })) {
      return file;
    }
  }
  throw std::invalid_argument(
      "it must be in a package, package://NAME/PATH, or in a folder of the parameter "
      "mesh_folders, file:///PATH");
}

}  // namespace fiber_proximity_ros

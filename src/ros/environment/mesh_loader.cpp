#include "src/ros/environment/mesh_loader.hpp"

#include <ros/package.h>

#include <algorithm>
#include <stdexcept>

#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "src/text/quote.hpp"
#include "src/text/with_context.hpp"

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

/// Follows all links. Parts that do not exist are taken as they are written.
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

std::shared_ptr<const fiber::TriangleMesh> MeshLoader::operator()(
    const std::string& resource, const Eigen::Vector3d& scale) const {
  return fiber::with_context("mesh " + fiber::quote(resource),
                             [&] { return fiber::read_mesh_file(resolve(resource), scale); });
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

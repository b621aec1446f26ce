#include "src/ros/bridges/octomap_cloud.hpp"

#include <sensor_msgs/point_cloud2_iterator.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/ros/bridges/octomap_leaves.hpp"

namespace fiber_proximity_ros {
namespace {

using Coordinates = sensor_msgs::PointCloud2Iterator<float>;

std::size_t count_cells(const std::vector<OctomapLeaf>& leaves) {
  std::uint64_t count = 0;
  for (const OctomapLeaf& leaf : leaves) {
    const auto edge = static_cast<std::uint64_t>(leaf.cells);
    count += edge * edge * edge;
    if (count > most_occupied_cells) {
      throw std::invalid_argument("more than " + std::to_string(most_occupied_cells) +
                                  " cells of the finest resolution are occupied, that many may be");
    }
  }
  return count;
}

void append_cells(const OctomapLeaf& leaf, double resolution, Coordinates& xyz) {
  const auto centre = [&](std::size_t axis, std::int32_t step) {
    return static_cast<float>((leaf.first[axis] + step + 0.5) * resolution);
  };
  for (std::int32_t i = 0; i < leaf.cells; ++i) {
    for (std::int32_t j = 0; j < leaf.cells; ++j) {
      for (std::int32_t k = 0; k < leaf.cells; ++k, ++xyz) {
        xyz[0] = centre(0, i);
        xyz[1] = centre(1, j);
        xyz[2] = centre(2, k);
      }
    }
  }
}

}  // namespace

sensor_msgs::PointCloud2 to_cloud(const octomap_msgs::Octomap& map) {
  using sensor_msgs::PointField;
  const std::vector<OctomapLeaf> leaves = read_occupied_leaves(map);
  sensor_msgs::PointCloud2 cloud;
  cloud.header = map.header;
  cloud.height = 1;
  cloud.is_dense = 1;
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  modifier.setPointCloud2Fields(3, "x", 1, PointField::FLOAT32, "y", 1, PointField::FLOAT32, "z", 1,
                                PointField::FLOAT32);
  modifier.resize(count_cells(leaves));
  if (leaves.empty()) {  // the iterator wants a first point
    return cloud;
  }
  Coordinates xyz(cloud, "x");
  for (const OctomapLeaf& leaf : leaves) {
    append_cells(leaf, map.resolution, xyz);
  }
  return cloud;
}

}  // namespace fiber_proximity_ros

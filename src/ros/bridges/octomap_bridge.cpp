#include "src/ros/bridges/octomap_bridge.hpp"

#include <sensor_msgs/point_cloud2_iterator.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "src/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

/// Cells along an edge of the root: octomap's trees have 16 levels below it.
constexpr std::int32_t root_cells = 65536;

/// [m] Between these, single precision has room for all coordinates and for half a cell.
constexpr double min_resolution = 1e-30;
constexpr double max_resolution = 1e30;

/// A cube of cells. Cell (i, j, k) reaches from there to (i + 1, j + 1, k + 1), times the
/// resolution.
struct OctomapLeaf {
  std::array<std::int32_t, 3> first{};  // the cell with the least indices
  std::int32_t cells = 1;               // along an edge, a power of two
};

OctomapLeaf child_of(const OctomapLeaf& cube, unsigned child) {
  OctomapLeaf octant{cube.first, cube.cells / 2};
  for (unsigned axis = 0; axis < 3; ++axis) {
    octant.first[axis] += (child >> axis & 1U) != 0 ? octant.cells : 0;
  }
  return octant;
}

/// Reads the occupied leaves from the bytes of one octree.
class LeafReader {
 public:
  explicit LeafReader(const octomap_msgs::Octomap& map)
      : data_(map.data), color_size_(map.id == "ColorOcTree" ? 3 : 0) {}

  std::vector<OctomapLeaf> read(bool is_binary) {
    constexpr OctomapLeaf root{{-root_cells / 2, -root_cells / 2, -root_cells / 2}, root_cells};
    if (is_binary) {
      read_binary(root);
    } else {
      read_full(root);
    }
    if (position_ != data_.size()) {
      throw std::invalid_argument("the octree ends after " + std::to_string(position_) + " of " +
                                  std::to_string(data_.size()) + " bytes of data");
    }
    return std::move(leaves_);
  }

 private:
  /// Reads an inner node, which has two bits for each child.
  void read_binary(const OctomapLeaf& cube) {
    enum State : unsigned { UNKNOWN, FREE, OCCUPIED, INNER };
    require_depth(cube);
    unsigned states = read_byte();
    states |= read_byte() << 8U;
    if (states == 0) {
      // octomap writes this for a root without children, be it free or occupied.
      throw std::invalid_argument("the inner node at byte " + std::to_string(position_ - 2) +
                                  " of data has no children");
    }
    for (unsigned child = 0; child < 8; ++child) {
      const unsigned state = states >> (2 * child) & 3U;
      if (state == OCCUPIED) {
        leaves_.push_back(child_of(cube, child));
      } else if (state == INNER) {
        read_binary(child_of(cube, child));
      }
    }
  }

  /// Reads any node: the logarithm of its odds, its colour, a bit for each child.
  void read_full(const OctomapLeaf& cube) {
    const float log_odds = read_float();
    skip(color_size_);
    const unsigned children = read_byte();
    if (std::isnan(log_odds)) {
      throw std::invalid_argument("the node that ends at byte " + std::to_string(position_) +
                                  " of data has log-odds of nan");
    }
    if (children == 0) {
      if (log_odds >= 0.0F) {  // octomap's threshold, a probability of one half
        leaves_.push_back(cube);
      }
      return;
    }
    require_depth(cube);
    for (unsigned child = 0; child < 8; ++child) {
      if ((children >> child & 1U) != 0) {
        read_full(child_of(cube, child));
      }
    }
  }

  void require_depth(const OctomapLeaf& cube) const {
    if (cube.cells == 1) {
      throw std::invalid_argument("the octree is deeper than 16 levels at byte " +
                                  std::to_string(position_) + " of data");
    }
  }

  unsigned read_byte() {
    const std::size_t place = position_;
    skip(1);
    return static_cast<std::uint8_t>(data_[place]);
  }

  float read_float() {
    float value = 0.0F;
    const std::size_t place = position_;
    skip(sizeof value);
    std::memcpy(&value, data_.data() + place, sizeof value);
    return value;
  }

  void skip(std::size_t count) {
    if (data_.size() - position_ < count) {
      throw std::invalid_argument("data end after " + std::to_string(data_.size()) +
                                  " bytes, in the middle of the octree");
    }
    position_ += count;
  }

  const std::vector<std::int8_t>& data_;
  std::size_t color_size_;  // [bytes]
  std::size_t position_ = 0;
  std::vector<OctomapLeaf> leaves_;
};

/// The leaves that octomap takes for occupied, in the order of the octree; those that were pruned
/// are larger than a cell. octomap's own readers cannot be used, as they trust what they read: data
/// that nest too deeply overflow the stack, and what is missing where data end is made up.
std::vector<OctomapLeaf> read_occupied_leaves(const octomap_msgs::Octomap& map) {
  if (map.id != "OcTree" && map.id != "ColorOcTree" && map.id != "OcTreeStamped") {
    throw std::invalid_argument("id is " + fiber::quote(map.id) +
                                ", it must be OcTree, ColorOcTree or OcTreeStamped");
  }
  if (!(map.resolution >= min_resolution && map.resolution <= max_resolution)) {
    std::ostringstream message;
    message << "resolution is " << map.resolution << ", it must be the edge of a cell in metres, "
            << min_resolution << " to " << max_resolution;
    throw std::invalid_argument(message.str());
  }
  if (map.data.empty()) {  // an octree that was never filled
    return {};
  }
  return LeafReader(map).read(map.binary != 0);
}

using Coordinates = sensor_msgs::PointCloud2Iterator<float>;

std::size_t count_cells(const std::vector<OctomapLeaf>& leaves) {
  std::uint64_t count = 0;
  for (const OctomapLeaf& leaf : leaves) {
    const auto edge = static_cast<std::uint64_t>(leaf.cells);
    count += edge * edge * edge;
    if (count > max_occupied_cells) {
      throw std::invalid_argument("more than " + std::to_string(max_occupied_cells) +
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

OctomapBridge::OctomapBridge(ros::NodeHandle node)
    : publisher_(node.advertise<sensor_msgs::PointCloud2>("cloud", 1, true)),
      log_(node.resolveName("octomap"), "octomap_msgs/Octomap"),
      subscriber_(node.subscribe("octomap", 1, &OctomapBridge::receive, this)) {}

void OctomapBridge::receive(const octomap_msgs::Octomap& map) {
  try {
    publisher_.publish(to_cloud(map));
  } catch (const std::invalid_argument& error) {
    log_.refuse(error.what());
  }
}

}  // namespace fiber_proximity_ros

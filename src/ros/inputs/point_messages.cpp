#include "src/ros/inputs/point_messages.hpp"

#include <array>
#include <cstring>
#include <stdexcept>
#include <string>

#include "src/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

using sensor_msgs::PointCloud2;
using sensor_msgs::PointField;

/// Where a coordinate stands in a point's bytes.
struct CoordinateField {
  std::uint32_t offset = 0;
  bool is_double = false;

  std::uint64_t end() const { return std::uint64_t{offset} + (is_double ? 8 : 4); }

  double read(const std::uint8_t* point) const {
    if (is_double) {
      double value = 0.0;
      std::memcpy(&value, point + offset, sizeof value);
      return value;
    }
    float value = 0.0F;
    std::memcpy(&value, point + offset, sizeof value);
    return static_cast<double>(value);
  }
};

CoordinateField find_coordinate(const PointCloud2& cloud, const std::string& name) {
  for (const PointField& field : cloud.fields) {
    if (field.name != name) {
      continue;
    }
    if (field.datatype != PointField::FLOAT32 && field.datatype != PointField::FLOAT64) {
      throw std::invalid_argument("field '" + name + "' has datatype " +
                                  std::to_string(field.datatype) +
                                  ", it must be 7 (FLOAT32) or 8 (FLOAT64)");
    }
    const CoordinateField coordinate{field.offset, field.datatype == PointField::FLOAT64};
    if (coordinate.end() > cloud.point_step) {
      throw std::invalid_argument("field '" + name + "' ends at byte " +
                                  std::to_string(coordinate.end()) + ", beyond point_step " +
                                  std::to_string(cloud.point_step));
    }
    return coordinate;
  }
  throw std::invalid_argument("the cloud has no field '" + name + "', it needs x, y and z");
}

void check_layout(const PointCloud2& cloud) {
  if (cloud.is_bigendian != 0) {
    throw std::invalid_argument("the cloud is big-endian, only little-endian is supported");
  }
  const std::uint64_t row = std::uint64_t{cloud.width} * cloud.point_step;
  if (cloud.row_step < row) {
    throw std::invalid_argument("row_step is " + std::to_string(cloud.row_step) + ", but " +
                                std::to_string(cloud.width) + " points of point_step " +
                                std::to_string(cloud.point_step) + " need " + std::to_string(row));
  }
  const std::uint64_t size = std::uint64_t{cloud.height} * cloud.row_step;
  if (cloud.data.size() != size) {
    throw std::invalid_argument("data has " + std::to_string(cloud.data.size()) + " bytes, but " +
                                std::to_string(cloud.height) + " row(s) of row_step " +
                                std::to_string(cloud.row_step) + " make " + std::to_string(size));
  }
}

/// Reads the items of a message's list as the points of one fibre.
template <class Message, class Items, class PositionOf>
void read_points(const Message& message, const Items& items, FiberBuffer& fibers,
                 const PositionOf& position_of) {
  fibers.clear();
  fibers.header = message.header;
  fibers.points.reserve(items.size());
  for (const auto& item : items) {
    fibers.points.push_back(to_vector(position_of(item)));
  }
  fibers.end_chain();
}

}  // namespace

void to_chains(const PointCloud2& message, FiberBuffer& fibers) {
  fibers.clear();
  fibers.header = message.header;
  const std::array<CoordinateField, 3> fields{
      find_coordinate(message, "x"), find_coordinate(message, "y"), find_coordinate(message, "z")};
  check_layout(message);
  fibers.points.reserve(std::size_t{message.width} * message.height);
  const std::size_t rows = message.width == 0 ? 0 : message.height;
  for (std::size_t row = 0; row < rows; ++row) {
    const std::uint8_t* point = message.data.data() + row * message.row_step;
    for (std::size_t column = 0; column < message.width; ++column, point += message.point_step) {
      fibers.points.emplace_back(fields[0].read(point), fields[1].read(point),
                                 fields[2].read(point));
    }
  }
  fibers.end_chain();
}

void to_chains(const sensor_msgs::PointCloud& message, FiberBuffer& fibers) {
  read_points(message, message.points, fibers, [](const auto& point) { return point; });
}

void to_chains(const geometry_msgs::PoseArray& message, FiberBuffer& fibers) {
  read_points(message, message.poses, fibers, [](const auto& pose) { return pose.position; });
}

void to_chains(const nav_msgs::Path& message, FiberBuffer& fibers) {
  for (std::size_t i = 0; i < message.poses.size(); ++i) {
    const std::string& frame = message.poses[i].header.frame_id;
    // Many publishers fill in only the path's frame.
    if (!frame.empty() && frame != message.header.frame_id) {
      throw std::invalid_argument(
          "pose " + std::to_string(i) + " is in frame " + fiber::quote(frame) + ", the path in " +
          fiber::quote(message.header.frame_id) + "; they must be the same");
    }
  }
  read_points(message, message.poses, fibers, [](const auto& pose) { return pose.pose.position; });
}

}  // namespace fiber_proximity_ros

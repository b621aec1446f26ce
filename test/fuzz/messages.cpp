// Messages that come to the node: of every type of input, of which it makes fibres, clouds of which
// it makes an octree, and obstacles. An input is two bytes, which type and which options, and the
// message as ROS sends it. `fuzz_messages --write_seeds=test/fuzz/corpus/messages`
// writes the seeds.
#include <visualization_msgs/MarkerArray.h>

#include <cmath>
#include <functional>
#include <memory>
#include <vector>

#include "fiber_proximity/ObstacleArray.h"
#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/environment/cloud_cells.hpp"
#include "src/ros/environment/obstacle_change.hpp"
#include "src/ros/inputs/closed_fibers.hpp"
#include "src/ros/inputs/marker_input.hpp"
#include "src/ros/inputs/missing_points.hpp"
#include "src/ros/inputs/point_messages.hpp"
#include "test/fuzz/fuzz_target.hpp"
#include "test/fuzz/message_stream.hpp"
#include "test/fuzz/seeds.hpp"

namespace {

using namespace fiber_proximity_ros;
using fiber::test::MessageStream;

struct Options {
  bool close_rings = false;
  MissingPoints missing_points = MissingPoints::REFUSE;
  MarkerInputOptions marker;
};

Options options_of(std::uint8_t bits) {
  Options options;
  const MissingPoints policies[] = {MissingPoints::REFUSE, MissingPoints::BRIDGE,
                                    MissingPoints::SPLIT, MissingPoints::SPLIT};
  options.missing_points = policies[bits & 3U];
  options.marker.radius_from_marker = (bits & 4U) != 0;
  options.marker.marker_namespace = (bits & 8U) != 0 ? "cable" : "";
  options.close_rings = (bits & 16U) != 0;
  return options;
}

bool read_markers(const std::vector<MarkerInput::MarkerPtr>& markers, const Options& options,
                  FiberBuffer& buffer) {
  return MarkerInput(options.marker).read(markers, ros::Time(1.0), buffer).is_for_input;
}
bool read(const visualization_msgs::Marker& message, const Options& options, FiberBuffer& buffer) {
  return read_markers({std::make_shared<const visualization_msgs::Marker>(message)}, options,
                      buffer);
}
bool read(const visualization_msgs::MarkerArray& message, const Options& options,
          FiberBuffer& buffer) {
  std::vector<MarkerInput::MarkerPtr> markers;
  for (const visualization_msgs::Marker& marker : message.markers) {
    markers.push_back(std::make_shared<const visualization_msgs::Marker>(marker));
  }
  return read_markers(markers, options, buffer);
}
template <class Message>
bool read(const Message& message, const Options& /*options*/, FiberBuffer& buffer) {
  to_chains(message, buffer);
  return true;
}

/// What the node does with a message of an input, as MessageReader::read.
template <class Message>
void try_fibers(MessageStream& stream, const Options& options) {
  const auto message = stream.read<Message>();
  FiberBuffer buffer;
  if (!read(message, options, buffer)) {
    return;
  }
  if (options.close_rings) {
    close_rings(buffer);
  }
  MissingPointCounts counts;
  resolve_missing_points(options.missing_points, buffer, counts);
  if (buffer.radii.empty()) {
    buffer.radii.assign(1, 0.01);
  }
  fiber::FiberAssembly fibers;
  assign(buffer, fibers);
  if (!buffer.names.empty() && buffer.names.size() != fibers.fiber_count()) {
    fiber::test::finding("names that are not those of the fibres");
  }
}

void try_cloud(MessageStream& stream, const Options& /*options*/) {
  const auto message = stream.read<sensor_msgs::PointCloud2>();
  FiberBuffer buffer;
  to_chains(message, buffer);
  CloudCells cells{CloudOptions{0.02}};
  const CloudCounts counts =
      cells.add(buffer.points, Eigen::Isometry3d::Identity(), message.header.stamp.toSec());
  const auto octree = cells.octree();
  if ((octree != nullptr) != (counts.used() > 0)) {
    fiber::test::finding("cells of no points, or points without cells");
  }
}

void try_obstacles(MessageStream& stream, const Options& /*options*/) {
  const auto message = stream.read<fiber_proximity::ObstacleArray>();
  std::vector<fiber::ObjectChange> changes;
  for (const fiber_proximity::Obstacle& obstacle : message.obstacles) {
    changes.push_back(to_change(obstacle));
  }
  fiber::World().apply(changes);
}

using Try = void (*)(MessageStream&, const Options&);
constexpr Try types[] = {try_fibers<fiber_proximity::FiberArray>,
                         try_fibers<sensor_msgs::PointCloud2>,
                         try_fibers<sensor_msgs::PointCloud>,
                         try_fibers<geometry_msgs::PoseArray>,
                         try_fibers<nav_msgs::Path>,
                         try_fibers<visualization_msgs::Marker>,
                         try_fibers<visualization_msgs::MarkerArray>,
                         try_cloud,
                         try_obstacles};

template <class Message>
std::string seed(std::uint8_t type, std::uint8_t options, const Message& message) {
  std::string bytes{static_cast<char>(type), static_cast<char>(options)};
  std::vector<std::uint8_t> wire(ros::serialization::serializationLength(message));
  ros::serialization::OStream stream(wire.data(), static_cast<std::uint32_t>(wire.size()));
  ros::serialization::serialize(stream, message);
  return bytes.append(wire.begin(), wire.end());
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) {
    return 0;
  }
  const fiber::test::Bounds bounds(fiber::test::times(200, size));
  MessageStream stream(data + 2, size - 2);
  try {
    types[data[0] % std::size(types)](stream, options_of(data[1]));
  } catch (const fiber::test::NoMessage&) {
    return 0;
  } catch (const std::invalid_argument& error) {
    fiber::test::check_error(error);
  }
  return 0;
}

namespace {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

geometry_msgs::Point point(double x, double y) { return to_message(Eigen::Vector3d(x, y, 0.5)); }

std_msgs::Header header() {
  std_msgs::Header header;
  header.frame_id = "world";
  header.stamp = ros::Time(1, 5);
  return header;
}

fiber_proximity::FiberArray fiber_array(bool is_complete) {
  fiber_proximity::FiberArray message;
  message.header = header();
  message.names = {"a", "b"};
  message.offsets = {0, 2, 7};
  for (int i = 0; i < 7; ++i) {
    message.points.push_back(point(is_complete || i != 4 ? 0.1 * i : missing, 0.2));
    message.radii.push_back(0.01 + 0.001 * i);
    message.joints.push_back(i == 1 || i == 2 ? 3 : -1);
  }
  message.points[2] = message.points[1];  // where the fibres are joined
  message.closed = {0, 1};
  return message;
}

sensor_msgs::PointCloud2 cloud() {
  sensor_msgs::PointCloud2 message;
  message.header = header();
  message.height = 2;
  message.width = 3;
  message.point_step = 16;
  message.row_step = message.width * message.point_step;
  for (const char* const name : {"x", "y", "z"}) {
    message.fields.emplace_back();
    message.fields.back().name = name;
    message.fields.back().offset = static_cast<std::uint32_t>(4 * (message.fields.size() - 1));
    message.fields.back().datatype = sensor_msgs::PointField::FLOAT32;
    message.fields.back().count = 1;
  }
  message.data.resize(std::size_t{message.height} * message.row_step);
  for (std::size_t i = 0; i < 6; ++i) {
    const auto x = static_cast<float>(i);
    std::memcpy(message.data.data() + i * message.point_step, &x, sizeof x);
  }
  return message;
}

visualization_msgs::Marker marker(std::int32_t type, std::int32_t id, std::size_t points) {
  visualization_msgs::Marker message;
  message.header = header();
  message.ns = "cable";
  message.id = id;
  message.type = type;
  message.pose.position = point(id, 0.0);
  message.pose.orientation.w = 1.0;
  message.scale.x = message.scale.y = 0.02;
  message.scale.z = 1.0;
  for (std::size_t i = 0; i < points; ++i) {
    message.points.push_back(point(static_cast<double>(i), 1.0));
  }
  return message;
}

visualization_msgs::MarkerArray markers(std::int32_t type, std::size_t points) {
  visualization_msgs::MarkerArray message;
  for (std::int32_t id = 0; id < 3; ++id) {
    message.markers.push_back(marker(type, id, points));
  }
  return message;
}

geometry_msgs::PoseArray pose_array() {
  geometry_msgs::PoseArray message;
  message.header = header();
  message.poses.resize(3);
  message.poses[1].position = point(1.0, 0.0);
  message.poses[2].position = point(1.0, missing);
  return message;
}

nav_msgs::Path path() {
  nav_msgs::Path message;
  message.header = header();
  message.poses.resize(2);
  message.poses[1].header.frame_id = "world";
  message.poses[1].pose.position = point(1.0, 0.0);
  return message;
}

sensor_msgs::PointCloud old_cloud() {
  sensor_msgs::PointCloud message;
  message.header = header();
  message.points.resize(3);
  message.points[1].x = 1.0F;
  message.points[2].x = 2.0F;
  return message;
}

fiber_proximity::ObstacleArray obstacles() {
  fiber_proximity::ObstacleArray message;
  message.obstacles.resize(2);
  fiber_proximity::Obstacle& all = message.obstacles[0];
  all.header = header();
  all.id = "all";
  for (const std::size_t dimensions : {3U, 1U, 2U, 2U}) {
    all.primitives.emplace_back();
    all.primitives.back().type = static_cast<std::uint8_t>(all.primitives.size());
    all.primitives.back().dimensions.assign(dimensions, 0.5);
  }
  all.capsules.resize(1);
  all.capsules[0].radius = all.capsules[0].length = 0.1;
  all.meshes.resize(1);
  all.meshes[0].vertices = {point(0, 0), point(1, 0), point(0, 1), point(1, 1)};
  all.meshes[0].triangles.resize(2);
  all.meshes[0].triangles[0].vertex_indices = {0, 1, 2};
  all.meshes[0].triangles[1].vertex_indices = {1, 3, 2};
  all.mesh_poses.resize(1);
  all.planes.resize(1);
  all.planes[0].coef = {0.0, 0.0, 1.0, 0.5};
  all.half_spaces = all.planes;
  message.obstacles[1].id = "all";
  message.obstacles[1].operation = fiber_proximity::Obstacle::MOVE;
  message.obstacles[1].pose.position = point(1, 2);
  message.obstacles[1].pose.orientation.w = 1.0;
  return message;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  using visualization_msgs::Marker;
  fiber::test::write_seeds(*argc, *argv,
                           {{"fiber_array", seed(0, 0, fiber_array(true))},
                            {"fiber_array_bridged", seed(0, 1, fiber_array(false))},
                            {"fiber_array_split", seed(0, 2, fiber_array(false))},
                            {"point_cloud2", seed(1, 0, cloud())},
                            {"point_cloud", seed(2, 0, old_cloud())},
                            {"pose_array", seed(3, 1, pose_array())},
                            {"path", seed(4, 0, path())},
                            {"line_strip", seed(5, 4, marker(Marker::LINE_STRIP, 1, 4))},
                            {"line_list", seed(6, 8, markers(Marker::LINE_LIST, 4))},
                            {"spheres", seed(6, 4, markers(Marker::SPHERE, 0))},
                            {"cylinders", seed(6, 0, markers(Marker::CYLINDER, 0))},
                            {"cloud", seed(7, 0, cloud())},
                            {"obstacles", seed(8, 0, obstacles())}});
  return 0;
}

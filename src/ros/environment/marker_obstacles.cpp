#include "src/ros/environment/marker_obstacles.hpp"

#include <ros/console.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "fiber_proximity/ros/conversions.hpp"
#include "src/environment/obstacle_parts.hpp"
#include "src/ros/environment/obstacle_change.hpp"
#include "src/text/quote.hpp"
#include "src/text/with_context.hpp"

namespace fiber_proximity_ros {
namespace {

using Operation = fiber::ObjectChange::Operation;
using Shapes = std::vector<fiber::PlacedShape>;
using visualization_msgs::Marker;

std::string marker_name(const Marker& marker) {
  return marker.ns + "/" + std::to_string(marker.id);
}

Eigen::Isometry3d marker_pose(const Marker& marker) {
  geometry_msgs::Pose pose = marker.pose;
  geometry_msgs::Quaternion& q = pose.orientation;
  if (q.x == 0.0 && q.y == 0.0 && q.z == 0.0 && q.w == 0.0) {
    q.w = 1.0;  // as rviz reads an orientation nobody filled in
  }
  return to_pose(pose);
}

void require_equal(double a, double b, const std::string& what) {
  if (!(a == b)) {
    throw std::invalid_argument("scale has the diameters " + std::to_string(a) + " and " +
                                std::to_string(b) + ", of a " + what + " they must be the same");
  }
}

fiber::Shape sphere_of(const Marker& marker) {
  require_equal(marker.scale.x, marker.scale.y, "sphere");
  require_equal(marker.scale.x, marker.scale.z, "sphere");
  return fiber::SphereShape{0.5 * marker.scale.x};
}

fiber::Shape cylinder_of(const Marker& marker) {
  require_equal(marker.scale.x, marker.scale.y, "cylinder");
  return fiber::CylinderShape{0.5 * marker.scale.x, marker.scale.z};
}

fiber::Shape triangles_of(const Marker& marker) {
  if (marker.points.size() % 3 != 0) {
    throw std::invalid_argument("a TRIANGLE_LIST of " + std::to_string(marker.points.size()) +
                                " points, it must have three for each triangle");
  }
  std::vector<Eigen::Vector3d> vertices;
  for (const geometry_msgs::Point& point : marker.points) {
    vertices.push_back(to_vector(marker.scale).cwiseProduct(to_vector(point)));
  }
  std::vector<fiber::TriangleMesh::Triangle> triangles;
  for (std::uint32_t i = 0; i + 2 < vertices.size(); i += 3) {
    triangles.push_back({i, i + 1, i + 2});
  }
  return std::make_shared<const fiber::TriangleMesh>(std::move(vertices), std::move(triangles));
}

/// The key of a mesh: its resource and its scale.
std::pair<std::string, std::array<double, 3>> key_of(const Marker& marker) {
  return {marker.mesh_resource, {marker.scale.x, marker.scale.y, marker.scale.z}};
}

/// The shape at each of the marker's points.
Shapes at_points(const Marker& marker, const fiber::Shape& shape) {
  Shapes shapes;
  for (const geometry_msgs::Point& point : marker.points) {
    shapes.push_back({shape, Eigen::Isometry3d(Eigen::Translation3d(to_vector(point)))});
  }
  return shapes;
}

Shapes one(const fiber::Shape& shape) { return {{shape, Eigen::Isometry3d::Identity()}}; }

bool is_body(const Marker& marker) {
  static const std::set<std::int32_t> types{
      Marker::CUBE,        Marker::SPHERE,        Marker::CYLINDER,     Marker::CUBE_LIST,
      Marker::SPHERE_LIST, Marker::TRIANGLE_LIST, Marker::MESH_RESOURCE};
  return types.count(marker.type) > 0;
}

}  // namespace

Change MarkerObstacles::change_of(std::shared_ptr<const Markers> markers, const ros::Time& now,
                                  double patience, Worker& worker) {
  TouchedObjects touched;
  std::vector<FramedName> frames(markers->size());
  for (std::size_t i = 0; i < markers->size(); ++i) {
    const Marker& marker = (*markers)[i];
    if (marker.action == Marker::DELETEALL) {
      touched.remove_all();
    } else if (marker.action == Marker::DELETE) {
      touched.remove(marker_name(marker));
    } else if (is_body(marker)) {
      touched.add(marker_name(marker));
      frames[i] = {"obstacle " + fiber::quote(marker_name(marker)), marker.header};
      if (marker.action == Marker::ADD && follows_frame(marker)) {
        const std::string problem = "marker " + fiber::quote(marker_name(marker)) +
                                    ": frame_locked is true in frame " +
                                    fiber::quote(marker.header.frame_id) +
                                    ", it must be false there: obstacles do not follow a frame";
        return {std::move(touched), {}, refusal(problem), patience, {}, {}};
      }
    }
  }
  const bool is_large = this->is_large(*markers);
  const auto prepare = [this, now, markers = std::move(markers)]() -> Change::Apply {
    return [this, steps = read(*markers, now)](const Change::Poses& poses,
                                               const Change::Names& /*cancelled*/) {
      apply(steps, poses);
    };
  };
  auto apply = Prepared<Change::Apply>(prepare, is_large ? &worker : nullptr);
  return {std::move(touched), std::move(frames), std::move(apply), patience, {}, {}};
}

/// Whether rviz would have a marker follow a frame that may move.
bool MarkerObstacles::follows_frame(const Marker& marker) const {
  return marker.frame_locked != 0 && tf2_name(marker.header.frame_id) != frame_.name();
}

bool MarkerObstacles::expire(const ros::Time& now) {
  std::vector<fiber::ObjectChange> removals;
  for (const auto& [name, expiry] : present()) {
    if (!expiry.isZero() && expiry <= now) {
      removals.push_back(removal_of(name));
    }
  }
  obstacles_.apply(removals, std::vector<ros::Time>(removals.size()));
  return !removals.empty();
}

void MarkerObstacles::set_back(const ros::Duration& by) {
  for (auto& [name, expiry] : names_) {
    if (!expiry.isZero()) {
      // Zero would be never.
      expiry = std::max(ros::Time(0, 1), ros::Time(std::max(0.0, expiry.toSec() - by.toSec())));
    }
  }
}

std::vector<MarkerObstacles::Step> MarkerObstacles::read(const Markers& markers,
                                                         const ros::Time& now) {
  std::vector<Step> steps;
  for (std::size_t i = 0; i < markers.size(); ++i) {
    fiber::with_context("marker " + fiber::quote(marker_name(markers[i])), [&] {
      if (auto step = read(markers[i], now)) {
        step->marker = i;
        steps.push_back(std::move(*step));
      }
    });
  }
  return steps;
}

std::optional<MarkerObstacles::Step> MarkerObstacles::read(const Marker& marker,
                                                           const ros::Time& now) {
  Step step;
  step.action = marker.action;
  if (marker.action == Marker::DELETEALL) {
    return step;
  }
  if (marker.action == Marker::DELETE) {
    step.change = removal_of(marker_name(marker));
    return step;
  }
  if (marker.action != Marker::ADD) {
    throw std::invalid_argument("action is " + std::to_string(marker.action) +
                                ", it must be 0 (ADD), 2 (DELETE) or 3 (DELETEALL)");
  }
  if (marker.lifetime < ros::Duration()) {
    throw std::invalid_argument("lifetime is " + std::to_string(marker.lifetime.toSec()) +
                                " s, it must be at least 0");
  }
  if (!is_body(marker)) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (ignored_types_.insert(marker.type).second) {
      ROS_INFO_STREAM("'" << topic_ << "': markers of type " << marker.type << ", such as "
                          << fiber::quote(marker_name(marker)) << ", are no obstacles");
    }
    return std::nullopt;
  }
  fiber::validate_obstacle_name(marker_name(marker));
  fiber::EnvironmentObject object{marker_name(marker), marker_pose(marker), shapes_of(marker)};
  step.change = {Operation::ADD, std::move(object)};
  fiber::validate(step.change);
  step.expiry = marker.lifetime.isZero() ? ros::Time() : now + marker.lifetime;
  return step;
}

Shapes MarkerObstacles::shapes_of(const Marker& marker) {
  switch (marker.type) {
    case Marker::CUBE:
      return one(fiber::BoxShape{to_vector(marker.scale)});
    case Marker::SPHERE:
      return one(sphere_of(marker));
    case Marker::CYLINDER:
      return one(cylinder_of(marker));
    case Marker::CUBE_LIST:
      return at_points(marker, fiber::BoxShape{to_vector(marker.scale)});
    case Marker::SPHERE_LIST:
      return at_points(marker, sphere_of(marker));
    case Marker::TRIANGLE_LIST:
      return one(triangles_of(marker));
    default:
      return one(mesh_of(marker));
  }
}

bool MarkerObstacles::is_large(const Markers& markers) const {
  std::size_t triangles = 0;
  for (const Marker& marker : markers) {
    if (marker.action == Marker::ADD && marker.type == Marker::MESH_RESOURCE &&
        !find_mesh(marker)) {
      return true;
    }
    triangles +=
        marker.type == Marker::TRIANGLE_LIST ? marker.points.size() / 3 : marker.points.size();
  }
  return is_large_mesh(triangles);
}

std::optional<fiber::Shape> MarkerObstacles::find_mesh(const Marker& marker) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto known = read_meshes_.find(key_of(marker));
  if (known != read_meshes_.end() && to_vector(marker.scale).allFinite()) {  // NaN equals any
    return known->second;
  }
  return std::nullopt;
}

fiber::Shape MarkerObstacles::mesh_of(const Marker& marker) {
  if (auto known = find_mesh(marker)) {
    return std::move(*known);
  }
  fiber::Shape mesh = meshes_(marker.mesh_resource, to_vector(marker.scale));
  const std::lock_guard<std::mutex> lock(mutex_);
  if (read_meshes_.size() >= max_read_meshes) {
    read_meshes_.clear();
  }
  read_meshes_.emplace(key_of(marker), mesh);
  return mesh;
}

void MarkerObstacles::apply(const std::vector<Step>& steps, const Change::Poses& poses) {
  Names names = present();
  std::vector<fiber::ObjectChange> changes;
  for (const Step& step : steps) {
    const std::string& name = step.change.object.name;
    if (step.action == Marker::ADD) {
      changes.push_back(step.change);
      changes.back().object.pose = poses[step.marker] * step.change.object.pose;
      names[name] = step.expiry;
    } else if (step.action == Marker::DELETEALL) {
      for (const auto& [present, expiry] : std::exchange(names, {})) {
        changes.push_back(removal_of(present));
      }
    } else if (names.erase(name) > 0) {
      changes.push_back(step.change);
    }
  }
  obstacles_.apply(changes, std::vector<ros::Time>(changes.size()), {}, topic_);
  names_ = std::move(names);
}

MarkerObstacles::Names MarkerObstacles::present() const {
  Names names;
  for (const auto& [name, expiry] : names_) {
    if (obstacles_.has(name, topic_)) {
      names.emplace(name, expiry);
    }
  }
  return names;
}

}  // namespace fiber_proximity_ros

#include "src/ros/inputs/marker_input.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/inputs/segment_welder.hpp"
#include "src/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

using visualization_msgs::Marker;
using Markers = std::vector<const Marker*>;

/// What a marker can be read as, best first.
enum class Kind { LINES, POINT_LIST, POINT, CYLINDER, NONE };

Kind kind_of(const Marker& marker) {
  switch (marker.type) {
    case Marker::LINE_STRIP:
    case Marker::LINE_LIST:
      return Kind::LINES;
    case Marker::POINTS:
    case Marker::SPHERE_LIST:
    case Marker::CUBE_LIST:
      return Kind::POINT_LIST;
    case Marker::SPHERE:
    case Marker::CUBE:
      return Kind::POINT;
    case Marker::CYLINDER:
      return Kind::CYLINDER;
    default:
      return Kind::NONE;
  }
}

std::string name_of(const Marker& marker) {
  return "marker " + fiber::shortened(marker.ns) + "/" + std::to_string(marker.id);
}

Eigen::Isometry3d pose_of(const Marker& marker) {
  const geometry_msgs::Quaternion& q = marker.pose.orientation;
  Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  if (rotation.norm() == 0.0) {
    rotation.setIdentity();  // as rviz reads an orientation nobody filled in
  }
  return Eigen::Translation3d(to_vector(marker.pose.position)) * rotation.normalized();
}

/// Reads markers of one kind into chains.
class MarkerReader {
 public:
  MarkerReader(const MarkerInputOptions& options, FiberBuffer& chains)
      : options_(options), chains_(chains), welder_(options.weld_tolerance, chains) {}

  void read_lines(const Markers& markers) {
    for (const Marker* marker : markers) {
      if (marker->type == Marker::LINE_LIST) {
        read_line_list(*marker);
      } else if (marker->points.size() == 2) {
        const Eigen::Isometry3d pose = pose_of(*marker);
        weld(*marker, pose * to_vector(marker->points[0]), pose * to_vector(marker->points[1]));
      } else {
        read_point_list(*marker);
      }
    }
    welder_.end_chain();
  }

  void read_point_lists(const Markers& markers) {
    for (const Marker* marker : markers) {
      read_point_list(*marker);
    }
  }

  void read_points(const Markers& markers) {
    for (const Marker* marker : markers) {
      chains_.points.push_back(to_vector(marker->pose.position));
    }
    begin_fiber(*markers.front());
    chains_.end_chain();
  }

  void read_cylinders(const Markers& markers) {
    for (const Marker* marker : markers) {
      const Eigen::Vector3d half(0.0, 0.0, 0.5 * marker->scale.z);
      const Eigen::Isometry3d pose = pose_of(*marker);
      weld(*marker, pose * Eigen::Vector3d(-half), pose * half);
    }
    welder_.end_chain();
  }

 private:
  void begin_fiber(const Marker& marker) {
    if (options_.radius_from_marker) {
      chains_.radii.push_back(0.5 * marker.scale.x);
    }
  }

  void weld(const Marker& marker, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    if (welder_.add(from, to)) {
      begin_fiber(marker);
    }
  }

  void read_point_list(const Marker& marker) {
    welder_.end_chain();
    const Eigen::Isometry3d pose = pose_of(marker);
    for (const geometry_msgs::Point& point : marker.points) {
      chains_.points.push_back(pose * to_vector(point));
    }
    begin_fiber(marker);
    chains_.end_chain();
  }

  void read_line_list(const Marker& marker) {
    if (marker.points.empty() || marker.points.size() % 2 != 0) {
      throw std::invalid_argument(name_of(marker) + ": a LINE_LIST of " +
                                  std::to_string(marker.points.size()) +
                                  " points, it must have two per segment and not be empty");
    }
    welder_.end_chain();
    const Eigen::Isometry3d pose = pose_of(marker);
    for (std::size_t i = 0; i < marker.points.size(); i += 2) {
      weld(marker, pose * to_vector(marker.points[i]), pose * to_vector(marker.points[i + 1]));
    }
    welder_.end_chain();
  }

  const MarkerInputOptions& options_;
  FiberBuffer& chains_;
  SegmentWelder welder_;
};

/// Single markers are points or segments of a chain in the order of their ids, whatever the order
/// they were sent in.
void sort_by_id(Markers& markers) {
  std::stable_sort(markers.begin(), markers.end(),
                   [](const Marker* a, const Marker* b) { return a->id < b->id; });
  const auto twin =
      std::adjacent_find(markers.begin(), markers.end(),
                         [](const Marker* a, const Marker* b) { return a->id == b->id; });
  if (twin != markers.end()) {
    throw std::invalid_argument(name_of(**twin) + " and " + name_of(**(twin + 1)) +
                                " have the same id, so their order along the fibre is unknown; "
                                "choose one fibre by its namespace");
  }
}

void check_frames(const Markers& markers) {
  for (const Marker* marker : markers) {
    if (marker->header.frame_id != markers.front()->header.frame_id) {
      throw std::invalid_argument(
          name_of(*marker) + " is in frame " + fiber::quote(marker->header.frame_id) + ", " +
          name_of(*markers.front()) + " in " + fiber::quote(markers.front()->header.frame_id) +
          "; they must be the same");
    }
  }
}

bool read(const Markers& added, const MarkerInputOptions& options, FiberBuffer& chains) {
  chains.clear();
  if (added.empty()) {
    return false;
  }
  Kind best = Kind::NONE;
  for (const Marker* marker : added) {
    best = std::min(best, kind_of(*marker));
  }
  Markers markers;
  std::copy_if(added.begin(), added.end(), std::back_inserter(markers),
               [best](const Marker* marker) { return kind_of(*marker) == best; });
  check_frames(markers);
  chains.header = markers.front()->header;
  MarkerReader reader(options, chains);
  switch (best) {
    case Kind::LINES:
      reader.read_lines(markers);
      break;
    case Kind::POINT_LIST:
      reader.read_point_lists(markers);
      break;
    case Kind::POINT:
      sort_by_id(markers);
      reader.read_points(markers);
      break;
    case Kind::CYLINDER:
      sort_by_id(markers);
      reader.read_cylinders(markers);
      break;
    case Kind::NONE:
      throw std::invalid_argument(
          name_of(*markers.front()) + " has type " + std::to_string(markers.front()->type) +
          "; fibres are read from LINE_STRIP, LINE_LIST, POINTS, SPHERE_LIST, CUBE_LIST, SPHERE, "
          "CUBE and CYLINDER");
  }
  return true;
}

bool is_read(const Marker& marker, const MarkerInputOptions& options) {
  return marker.action == Marker::ADD &&
         (options.marker_namespace.empty() || options.marker_namespace == marker.ns);
}

}  // namespace

bool to_chains(const visualization_msgs::MarkerArray& message, const MarkerInputOptions& options,
               FiberBuffer& chains) {
  Markers added;
  for (const Marker& marker : message.markers) {
    if (is_read(marker, options)) {
      added.push_back(&marker);
    }
  }
  return read(added, options, chains);
}

bool to_chains(const Marker& message, const MarkerInputOptions& options, FiberBuffer& chains) {
  return read(is_read(message, options) ? Markers{&message} : Markers{}, options, chains);
}

}  // namespace fiber_proximity_ros

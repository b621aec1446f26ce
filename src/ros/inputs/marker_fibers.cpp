#include "src/ros/inputs/marker_fibers.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <sstream>
#include <stdexcept>

#include "src/ros/inputs/segment_welder.hpp"
#include "src/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

using visualization_msgs::Marker;
using Markers = std::vector<const Marker*>;

/// The largest gap between ends of different namespaces that are joined, as a part of the shorter
/// segment's length.
constexpr double max_between_namespaces = 1e-3;

/// The ways to read a marker, best first.
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

Eigen::Isometry3d pose_of(const Marker& marker) {
  const geometry_msgs::Quaternion& q = marker.pose.orientation;
  Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  if (rotation.norm() == 0.0) {
    rotation.setIdentity();  // as rviz reads an orientation nobody filled in
  }
  return Eigen::Translation3d(to_vector(marker.pose.position)) * rotation.normalized();
}

/// Markers that may be of one cable.
struct Group {
  Markers markers;
  double tolerance;  // between one and the next
};

/// @throws std::invalid_argument for markers of one id where only ids tell the order along a fibre
void sort_by_id(Markers& markers, Kind kind) {
  std::stable_sort(markers.begin(), markers.end(),
                   [](const Marker* a, const Marker* b) { return a->id < b->id; });
  const auto twin =
      std::adjacent_find(markers.begin(), markers.end(),
                         [](const Marker* a, const Marker* b) { return a->id == b->id; });
  if (twin != markers.end() && (kind == Kind::POINT || kind == Kind::CYLINDER)) {
    throw std::invalid_argument(name_of(**twin) + " and " + name_of(**(twin + 1)) +
                                " have the same id, so their order along the fibre is unknown; "
                                "choose one fibre by its namespace");
  }
}

std::vector<Group> groups_of(const Markers& markers, Kind kind, double weld_tolerance) {
  std::map<std::string, Markers> namespaces;
  for (const Marker* marker : markers) {
    namespaces[marker->ns].push_back(marker);
  }
  std::vector<Group> groups;
  Group lone{{}, std::min(weld_tolerance, max_between_namespaces)};
  for (auto& [name, own] : namespaces) {
    if (own.size() == 1) {
      lone.markers.push_back(own.front());
    } else {
      groups.push_back({std::move(own), weld_tolerance});
    }
  }
  if (!lone.markers.empty()) {
    sort_by_id(lone.markers, kind);
    groups.push_back(std::move(lone));
  }
  return groups;
}

/// Reads the fibres that markers of one kind show.
class MarkerReader {
 public:
  MarkerReader(const MarkerInputOptions& options, FiberBuffer& fibers)
      : options_(options), fibers_(fibers), welder_(fibers) {}

  void read(const Group& group, Kind kind) {
    switch (kind) {
      case Kind::LINES:
        for (const Marker* marker : group.markers) {
          read_lines(*marker, group.tolerance);
        }
        break;
      case Kind::POINT_LIST:
        for (const Marker* marker : group.markers) {
          read_point_list(*marker);
        }
        break;
      case Kind::POINT:
        read_points(group.markers);
        break;
      default:
        for (const Marker* marker : group.markers) {
          read_cylinder(*marker, group.tolerance);
        }
    }
    welder_.end_fiber();
  }

  /// Names all fibres.
  void name_fibers() {
    std::map<std::string, std::size_t> counts;
    for (const Marker* first : firsts_) {
      ++counts[first->ns];
    }
    std::map<std::string, std::size_t> numbers;
    for (const Marker* first : firsts_) {
      std::string name = options_.name;
      name += counts.size() > 1 ? "/" + first->ns : "";
      if (counts[first->ns] > 1) {
        name += "/" + std::to_string(numbers[first->ns]++);
      }
      fibers_.names.push_back(name);
    }
  }

  void add_remarks(std::vector<std::string>& remarks) const {
    if (welder_.turned_count() > 0 && has_lines_) {  // an axis has no direction of its own
      remarks.push_back(std::to_string(welder_.turned_count()) +
                        " segment(s) are turned round to be joined to those before them");
    }
    if (welder_.largest_gap() > 0.0) {
      std::ostringstream remark;
      remark << "ends up to " << welder_.largest_gap()
             << " m apart are moved together, as weld_tolerance, " << options_.weld_tolerance
             << " of a segment, allows";
      remarks.push_back(remark.str());
    }
  }

 private:
  void begin_fiber(const Marker& marker) {
    firsts_.push_back(&marker);
    if (options_.radius_from_marker) {
      fibers_.radii.push_back(0.5 * marker.scale.x);
    }
  }

  void weld(const Marker& marker, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
            double tolerance) {
    if (welder_.add(from, to, tolerance)) {
      begin_fiber(marker);
    }
  }

  void read_lines(const Marker& marker, double tolerance) {
    has_lines_ = true;
    if (marker.type == Marker::LINE_LIST) {
      read_line_list(marker);
    } else if (marker.points.size() == 2) {
      const Eigen::Isometry3d pose = pose_of(marker);
      weld(marker, pose * to_vector(marker.points[0]), pose * to_vector(marker.points[1]),
           tolerance);
    } else {
      read_point_list(marker);
    }
  }

  void read_line_list(const Marker& marker) {
    if (marker.points.empty() || marker.points.size() % 2 != 0) {
      throw std::invalid_argument(name_of(marker) + ": a LINE_LIST of " +
                                  std::to_string(marker.points.size()) +
                                  " points, it must have two per segment and not be empty");
    }
    welder_.end_fiber();
    const Eigen::Isometry3d pose = pose_of(marker);
    for (std::size_t i = 0; i < marker.points.size(); i += 2) {
      weld(marker, pose * to_vector(marker.points[i]), pose * to_vector(marker.points[i + 1]),
           options_.weld_tolerance);
    }
    welder_.end_fiber();
  }

  void read_point_list(const Marker& marker) {
    welder_.end_fiber();
    const Eigen::Isometry3d pose = pose_of(marker);
    for (const geometry_msgs::Point& point : marker.points) {
      fibers_.points.push_back(pose * to_vector(point));
    }
    begin_fiber(marker);
    fibers_.end_chain();
  }

  void read_points(const Markers& markers) {
    for (const Marker* marker : markers) {
      fibers_.points.push_back(to_vector(marker->pose.position));
    }
    begin_fiber(*markers.front());
    fibers_.end_chain();
  }

  void read_cylinder(const Marker& marker, double tolerance) {
    const Eigen::Vector3d half(0.0, 0.0, 0.5 * marker.scale.z);
    const Eigen::Isometry3d pose = pose_of(marker);
    weld(marker, pose * Eigen::Vector3d(-half), pose * half, tolerance);
  }

  const MarkerInputOptions& options_;
  FiberBuffer& fibers_;
  SegmentWelder welder_;
  bool has_lines_ = false;
  Markers firsts_;  // by fibre: the marker that it begins with
};

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

}  // namespace

std::string name_of(const Marker& marker) {
  return "marker " + fiber::shortened(marker.ns) + "/" + std::to_string(marker.id);
}

void to_chains(const Markers& markers, const MarkerInputOptions& options, FiberBuffer& fibers,
               std::vector<std::string>& remarks) {
  fibers.clear();
  Kind best = Kind::NONE;
  for (const Marker* marker : markers) {
    best = std::min(best, kind_of(*marker));
  }
  if (best == Kind::NONE) {
    throw std::invalid_argument(
        name_of(*markers.front()) + " has type " + std::to_string(markers.front()->type) +
        "; fibres are read from LINE_STRIP, LINE_LIST, POINTS, SPHERE_LIST, CUBE_LIST, SPHERE, "
        "CUBE and CYLINDER");
  }
  Markers read;
  std::copy_if(markers.begin(), markers.end(), std::back_inserter(read),
               [best](const Marker* marker) { return kind_of(*marker) == best; });
  check_frames(read);
  fibers.header = read.front()->header;
  MarkerReader reader(options, fibers);
  for (const Group& group : groups_of(read, best, options.weld_tolerance)) {
    reader.read(group, best);
  }
  reader.name_fibers();
  reader.add_remarks(remarks);
}

}  // namespace fiber_proximity_ros

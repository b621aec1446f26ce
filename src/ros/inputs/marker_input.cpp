#include "src/ros/inputs/marker_input.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "src/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

using visualization_msgs::Marker;
using Markers = std::vector<const Marker*>;

bool is_known(const Eigen::Vector3d& point) { return point.allFinite(); }

/// Infinite where one of the points is missing.
double distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return is_known(a) && is_known(b) ? (a - b).norm() : std::numeric_limits<double>::infinity();
}

double nearer_end(const Eigen::Vector3d& point, const Eigen::Vector3d& from,
                  const Eigen::Vector3d& to) {
  return std::min(distance(point, from), distance(point, to));
}

/// Joins segments that come one after another into chains. Ends with a coordinate that is not
/// finite are missing: a chain goes on across them, with the missing points in it, unless the
/// points known on both sides are farther apart than the segments between them can reach.
class SegmentWelder {
 public:
  /// @param tolerance largest gap between ends that are joined, as a fraction of the shorter
  ///        segment's length
  SegmentWelder(double tolerance, FiberBuffer& chains) : tolerance_(tolerance), chains_(chains) {}

  /// Continues the chain with this segment, turned round if need be, and meets the one before it
  /// halfway; or begins a new chain if it is too far from its end.
  /// @returns true if a new chain began
  bool add(Eigen::Vector3d from, Eigen::Vector3d to) {
    const double length = is_known(from) && is_known(to) ? (to - from).norm()
                                                         : std::numeric_limits<double>::quiet_NaN();
    const double tolerance = std::fmax(0.0, tolerance_ * std::fmin(length, last_length_));
    if (chain_size() > 0) {
      turn_first_segment_towards(from, to, tolerance);
      Eigen::Vector3d& end = chains_.points.back();
      if (distance(to, end) < distance(from, end) &&
          (is_known(from) || distance(to, end) <= tolerance)) {
        std::swap(from, to);
      }
      if (is_known(end) && is_known(from)) {
        if (distance(from, end) <= tolerance) {
          end = 0.5 * (end + from);
          push(to, length);
          return false;
        }
      } else if (reaches(from, to, length)) {
        if (is_known(from) || (is_known(end) && is_known(to))) {
          push(from, length);  // else it is the same missing point as the end, or as `to`
        }
        push(to, length);
        return false;
      }
      end_chain();
    }
    longest_ = 0.0;
    push(from, length);
    push(to, length);
    return true;
  }

  /// Ends the chain; what follows begins a new one.
  void end_chain() {
    if (chain_size() > 0) {
      chains_.end_chain();
    }
  }

 private:
  std::size_t chain_size() const { return chains_.points.size() - chains_.offsets.back(); }

  void push(const Eigen::Vector3d& point, double length) {
    chains_.points.push_back(point);
    last_length_ = length;
    longest_ = std::fmax(longest_, length);
  }

  /// True if the chain may go on across missing points: if what is known on both sides is no
  /// farther apart than the segments between them would reach, or nothing is known.
  bool reaches(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double length) const {
    const auto known =
        std::find_if(chains_.points.rbegin(),
                     chains_.points.rbegin() + static_cast<std::ptrdiff_t>(chain_size()), is_known);
    const auto missing = static_cast<double>(known - chains_.points.rbegin());
    const double longest = std::fmax(longest_, length);
    const bool is_compared = static_cast<std::size_t>(missing) < chain_size() &&
                             (is_known(from) || is_known(to)) && longest > 0.0;
    const double segments = missing + (is_known(from) ? 1.0 : 2.0) + tolerance_;
    return !is_compared || distance(*known, is_known(from) ? from : to) <= segments * longest;
  }

  void turn_first_segment_towards(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                  double tolerance) {
    if (chain_size() != 2) {
      return;  // later ones have an end that is joined already
    }
    Eigen::Vector3d& head = *(chains_.points.end() - 2);
    Eigen::Vector3d& tail = chains_.points.back();
    const double gap = nearer_end(head, from, to);
    if (gap < nearer_end(tail, from, to) && (is_known(tail) || gap <= tolerance)) {
      head.swap(tail);
    }
  }

  double tolerance_;
  FiberBuffer& chains_;
  double last_length_ = 0.0;  // nan of a segment with a missing end
  double longest_ = 0.0;      // of the chain's segments
};

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
        weld_pairs(*marker);
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

  void weld_pairs(const Marker& marker) {
    const Eigen::Isometry3d pose = pose_of(marker);
    for (std::size_t i = 0; i < marker.points.size(); i += 2) {
      weld(marker, pose * to_vector(marker.points[i]), pose * to_vector(marker.points[i + 1]));
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
    weld_pairs(marker);
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

#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <string>

#include "fiber_proximity/ros/conversions.hpp"

namespace fiber_proximity_ros {

/// How markers, which were made to be looked at, are read as fibres.
struct MarkerInputOptions {
  /// Read only markers of this namespace; empty: of all.
  std::string marker_namespace;

  /// Half the marker's width is the fibre's radius. Off by default: it hardly ever is.
  bool radius_from_marker = false;

  /// Segments that come one by one are joined when their ends lie within this fraction of the
  /// shorter one's length.
  double weld_tolerance = 0.25;
};

/// Reads the fibres of one message. Of the kinds below the first that occurs is read, the others
/// repeat the same cable in another look:
///  1. lines: a LINE_STRIP is a fibre; the segments of a LINE_LIST, and LINE_STRIPs of two points,
///     are welded into fibres;
///  2. lists of points: each POINTS, SPHERE_LIST or CUBE_LIST is a fibre;
///  3. single SPHEREs and CUBEs: their centres by ascending id are one fibre;
///  4. CYLINDERs: their axes by ascending id are welded into fibres.
/// Poses of markers are applied. All markers that are read must be in one frame.
/// @returns false if there is nothing in it to read: only other namespaces or deletions
/// @throws std::invalid_argument for markers of other types only, and for malformed ones
bool to_chains(const visualization_msgs::MarkerArray& message, const MarkerInputOptions& options,
               FiberBuffer& chains);
bool to_chains(const visualization_msgs::Marker& message, const MarkerInputOptions& options,
               FiberBuffer& chains);

}  // namespace fiber_proximity_ros

#pragma once

#include <visualization_msgs/Marker.h>

#include <string>
#include <vector>

#include "fiber_proximity/ros/conversions.hpp"

namespace fiber_proximity_ros {

/// How markers, which were made to be looked at, are read as fibres.
struct MarkerInputOptions {
  std::string name;  ///< of the fibre; of several it begins with that

  /// Read only markers of this namespace; empty: of all.
  std::string marker_namespace;

  /// Half the marker's width is the fibre's radius. Off by default: it hardly ever is.
  bool radius_from_marker = false;

  /// Segments that come one by one are joined when their ends lie within this part of the shorter
  /// one's length.
  double weld_tolerance = 0.25;

  double timeout = 1.0;  ///< [s] a marker that is not sent again for so long is left out
};

std::string name_of(const visualization_msgs::Marker& marker);

/// Reads the fibres that markers show. Of the kinds below the first that occurs is read, the others
/// repeat the same cable in another look:
///  1. lines: a LINE_STRIP is a fibre; the segments of a LINE_LIST, and LINE_STRIPs of two points,
///     are welded into fibres;
///  2. lists of points: each POINTS, SPHERE_LIST or CUBE_LIST is a fibre;
///  3. single SPHEREs and CUBEs: their centres by ascending id are one fibre;
///  4. CYLINDERs: their axes by ascending id are welded into fibres.
/// Poses of markers are applied. All markers that are read must be in one frame.
///
/// A namespace with several markers of the kind is a cable of its own. Those with one marker each
/// may be one cable, node by node or segment by segment: centres are one fibre, segments are welded
/// where they coincide, within a thousandth of the shorter one.
///
/// A fibre has the name of the options; of several NAME/NAMESPACE, and NAME/NAMESPACE/0, … where
/// these are the same; of several in a single namespace NAME/0, ….
/// @param markers sorted by namespace and id, one at least
/// @param remarks what was done that nobody has asked for is appended: segments turned round, ends
///                moved together
/// @throws std::invalid_argument for markers of other types only, and for malformed ones
void to_chains(const std::vector<const visualization_msgs::Marker*>& markers,
               const MarkerInputOptions& options, FiberBuffer& fibers,
               std::vector<std::string>& remarks);

}  // namespace fiber_proximity_ros

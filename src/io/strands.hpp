#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/io/number.hpp"

namespace fiber {

/// Strands as a file has them, of any number of points each.
struct Strands {
  std::vector<Eigen::Vector3d> points;    // [m]
  std::vector<std::uint32_t> offsets{0};  // as those of FiberAssembly
  std::vector<double> radii;              // [m] as many as radius_per says, or none
  RadiusPer radius_per = RadiusPer::POINT;
  FiberTopology topology;  // closed by strand and joints by point, where there are any
  std::vector<std::string> notes;

  std::size_t count() const { return offsets.size() - 1; }

  /// Ends a strand with the last point.
  /// @param name what errors call the file
  /// @throws FileError for more points than an assembly can have
  void end_strand(const std::string& name);
};

/// Sees that a point is one that an assembly can have.
/// @param name  what errors call the file
/// @param place called for an error only, with an axis: where the coordinate stands in the file
/// @throws FileError
template <class Place>
void check_point(const std::string& name, const Eigen::Vector3d& point, const Place& place) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!FiberAssembly::is_valid_coordinate(point[axis])) {
      throw FileError(name, std::string(1, "xyz"[axis]) + " of " + place(axis) + " is " +
                                text_of(point[axis]) + ", " + FiberAssembly::coordinate_rule);
    }
  }
}

/// Sees that a radius is one that an assembly can have.
/// @param place called for an error only: what has the radius, and where it stands
template <class Place>
void check_radius(const std::string& name, double radius, const Place& place) {
  if (!FiberAssembly::is_valid_radius(radius)) {
    throw FileError(name, place() + " is " + text_of(radius) + ", " + FiberAssembly::radius_rule);
  }
}

/// The note about fibres that ReadOptions::skip_single_points leaves out.
std::string note_of_skipped(std::size_t count);

/// Tells how fibres of fewer than two points can be read all the same.
constexpr const char* single_point_rule =
    "a fibre needs at least 2; skip_single_points, --skip-single-points, leaves such fibres out";

/// Makes a file of strands, one frame without a number.
/// @param name  what errors call the file
/// @param what  what the format calls a strand, for errors
/// @throws FileError for a strand of fewer than two points that is not to be skipped
/// @throws std::invalid_argument for a bad default radius
FiberFile to_file(Strands strands, const ReadOptions& options, const std::string& name,
                  const char* what);

/// Whether an array of this name holds radii: radius or TubeRadius, in capitals or not.
bool is_radius_name(std::string_view name);

}  // namespace fiber

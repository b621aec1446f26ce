#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/ros/outputs/tube_mesh.hpp"
#include "src/rviz/fiber_colors.hpp"

namespace fiber_proximity_rviz {

/// As it lies in a graphics card's buffer.
struct MeshVertex {
  std::array<float, 3> position;   ///< [m] from the mesh's origin
  std::array<float, 3> direction;  ///< unit vector: outwards of a tube, along a ribbon
  Color color;
  float offset;  ///< [m] of a ribbon: from the axis to this edge, which is left if above 0
};
static_assert(sizeof(MeshVertex) == 32, "the buffer has no gaps");

/// Vertices of a ribbon at a point of its fibre, left and right.
constexpr std::size_t edges_of_ribbon = 2;

/// Fibres as something to draw. Single precision is enough, for positions count from an origin
/// among the fibres.
struct FiberMesh {
  enum class Kind { ribbons, tubes };

  Kind kind = Kind::ribbons;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< [m] in the fibres' frame
  std::vector<MeshVertex> vertices;
  /// Three per triangle of tubes, counter-clockwise seen from outside. Of ribbons none: how many
  /// triangles they take depends on the view (make_indices()).
  std::vector<std::uint32_t> indices;
  Eigen::AlignedBox3f box;  ///< of what is drawn, from the origin; empty without vertices
};

/// Makes meshes, in parallel, in the memory of the one before.
class FiberMesher {
 public:
  /// Largest magnitude of what can be drawn [m]; single precision holds its square.
  static constexpr double max_drawn = 1e15;
  /// More would take half a gigabyte, and tubes as much again.
  static constexpr std::size_t max_vertices = std::size_t{1} << 24;

  /// Each fibre as a ribbon as wide as it, in the direction that the viewer chooses: both edges of
  /// a point lie on the axis, with the offset that is to be gone from there.
  /// @param colors one per point
  /// @throws std::invalid_argument naming the point that lies beyond `max_drawn`, for a radius
  /// above
  ///         it, or naming the number of vertices above `max_vertices`
  const FiberMesh& make_ribbons(const fiber::FiberAssembly& fibers,
                                const std::vector<Color>& colors);

  /// Each fibre as a tube of its radius, closed by half spheres, with the corners of
  /// fiber_proximity_ros::sweep_tube(). A ring has the colour of its point.
  /// @param colors one per point
  /// @param sides  at least 3
  /// @throws std::invalid_argument as make_ribbons()
  const FiberMesh& make_tubes(const fiber::FiberAssembly& fibers, const std::vector<Color>& colors,
                              int sides);

 private:
  FiberMesh mesh_;
  std::vector<std::vector<fiber_proximity_ros::TubeRing>> rings_;  // by fibre
};

}  // namespace fiber_proximity_rviz

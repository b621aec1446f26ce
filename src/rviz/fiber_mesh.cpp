#include "src/rviz/fiber_mesh.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace fiber_proximity_rviz {
namespace {

using Eigen::Vector3d;
using fiber::FiberAssembly;
using fiber_proximity_ros::TubeRing;

constexpr std::size_t corners_of_triangle = 3;

std::array<float, 3> to_floats(const Vector3d& vector) {
  return {static_cast<float>(vector.x()), static_cast<float>(vector.y()),
          static_cast<float>(vector.z())};
}

/// Calls a function with each fibre, in parallel.
template <class Function>
void for_each_fiber(const FiberAssembly& fibers, const Function& function) {
  tbb::parallel_for(0U, static_cast<std::uint32_t>(fibers.fiber_count()), function);
}

void require_drawable_size(const FiberAssembly& fibers) {
  if (fibers.largest_radius() > FiberMesher::max_drawn) {
    throw std::invalid_argument("a fibre is too thick to draw; radii may be 1e15 m at most");
  }
  for (std::size_t i = 0; i < fibers.point_count(); ++i) {
    if (!(fibers.points()[i].cwiseAbs().maxCoeff() <= FiberMesher::max_drawn)) {
      throw std::invalid_argument("point " + std::to_string(i) +
                                  " is too far away to draw; coordinates may be 1e15 m at most");
    }
  }
}

void require_vertex_count(std::size_t vertices) {
  if (vertices > FiberMesher::max_vertices) {
    throw std::invalid_argument(std::to_string(vertices) + " vertices are too many to draw; " +
                                std::to_string(FiberMesher::max_vertices) + " are the most");
  }
}

/// Unit vector along the chain at a point; a zero vector where its neighbours coincide.
Vector3d tangent_at(const FiberAssembly& fibers, std::uint32_t begin, std::uint32_t end,
                    std::uint32_t point) {
  const std::uint32_t before = point > begin ? point - 1 : point;
  const std::uint32_t after = point + 1 < end ? point + 1 : point;
  return (fibers.points()[after] - fibers.points()[before]).stableNormalized();
}

/// The offset [m] of a ribbon's edges: above 0, so that its sign tells left from right.
float ribbon_offset(const FiberAssembly& fibers, std::uint32_t segment) {
  return std::max(static_cast<float>(fibers.segment_radius(segment)),
                  std::numeric_limits<float>::min());
}

Eigen::AlignedBox3f box_of(const std::vector<MeshVertex>& vertices) {
  using VertexRange = tbb::blocked_range<std::size_t>;
  return tbb::parallel_reduce(
      VertexRange(0, vertices.size(), 10000), Eigen::AlignedBox3f(),
      [&vertices](const VertexRange& range, Eigen::AlignedBox3f box) {
        for (std::size_t i = range.begin(); i != range.end(); ++i) {
          box.extend(Eigen::Map<const Eigen::Vector3f>(vertices[i].position.data()));
        }
        return box;
      },
      [](const Eigen::AlignedBox3f& a, const Eigen::AlignedBox3f& b) { return a.merged(b); });
}

}  // namespace

const FiberMesh& FiberMesher::make_ribbons(const FiberAssembly& fibers,
                                           const std::vector<Color>& colors) {
  assert(colors.size() == fibers.point_count());
  require_vertex_count(edges_of_ribbon * fibers.point_count());
  require_drawable_size(fibers);
  mesh_.kind = FiberMesh::Kind::ribbons;
  mesh_.origin = fibers.point_count() > 0 ? fibers.points().front() : Vector3d::Zero();
  mesh_.vertices.resize(edges_of_ribbon * fibers.point_count());
  mesh_.indices.clear();
  for_each_fiber(fibers, [&](std::uint32_t fiber) {
    const std::uint32_t begin = fibers.offsets()[fiber];
    const std::uint32_t end = fibers.offsets()[fiber + 1];
    MeshVertex* vertex = mesh_.vertices.data() + edges_of_ribbon * begin;
    for (std::uint32_t point = begin; point < end; ++point) {
      const float offset = ribbon_offset(fibers, point + 1 < end ? point : point - 1);
      const std::array<float, 3> position = to_floats(fibers.points()[point] - mesh_.origin);
      const std::array<float, 3> tangent = to_floats(tangent_at(fibers, begin, end, point));
      *vertex++ = {position, tangent, colors[point], offset};
      *vertex++ = {position, tangent, colors[point], -offset};
    }
  });
  mesh_.box = box_of(mesh_.vertices);
  if (!mesh_.box.isEmpty()) {
    const auto radius = static_cast<float>(fibers.largest_radius());
    mesh_.box.min().array() -= radius;
    mesh_.box.max().array() += radius;
  }
  return mesh_;
}

const FiberMesh& FiberMesher::make_tubes(const FiberAssembly& fibers,
                                         const std::vector<Color>& colors, int sides) {
  assert(colors.size() == fibers.point_count());
  const std::vector<Eigen::Vector2d> corners = fiber_proximity_ros::corner_directions(sides);
  require_vertex_count(fibers.point_count() * corners.size());  // at least
  require_drawable_size(fibers);

  rings_.resize(fibers.fiber_count());
  for_each_fiber(fibers, [&](std::uint32_t fiber) {
    fiber_proximity_ros::sweep_tube(fibers, fiber, rings_[fiber]);
  });
  std::vector<std::size_t> first_vertex{0};
  std::vector<std::size_t> first_triangle{0};
  for (const std::vector<TubeRing>& rings : rings_) {
    const std::size_t corners_between_poles = skin_rows(rings) * corners.size();
    first_vertex.push_back(first_vertex.back() + corners_between_poles + 2);
    first_triangle.push_back(first_triangle.back() + 2 * corners_between_poles);
  }
  require_vertex_count(first_vertex.back());

  mesh_.kind = FiberMesh::Kind::tubes;
  mesh_.origin = fibers.point_count() > 0 ? fibers.points().front() : Vector3d::Zero();
  mesh_.vertices.resize(first_vertex.back());
  mesh_.indices.resize(corners_of_triangle * first_triangle.back());
  for_each_fiber(fibers, [&](std::uint32_t fiber) {
    const std::vector<TubeRing>& rings = rings_[fiber];
    MeshVertex* vertex = mesh_.vertices.data() + first_vertex[fiber];
    for_each_corner(rings, corners, mesh_.origin,
                    [&](const Vector3d& position, const Vector3d& normal, const TubeRing& ring) {
                      *vertex++ = {to_floats(position), to_floats(normal.normalized()),
                                   colors[ring.point], 0.0F};
                    });
    const auto first = static_cast<std::uint32_t>(first_vertex[fiber]);
    std::uint32_t* index = mesh_.indices.data() + corners_of_triangle * first_triangle[fiber];
    fiber_proximity_ros::for_each_triangle(
        static_cast<std::uint32_t>(skin_rows(rings)), static_cast<std::uint32_t>(corners.size()),
        [&index, first](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
          for (const std::uint32_t corner : {a, b, c}) {
            *index++ = first + corner;
          }
        });
  });
  mesh_.box = box_of(mesh_.vertices);
  return mesh_;
}

}  // namespace fiber_proximity_rviz

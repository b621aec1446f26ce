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
using Range = tbb::blocked_range<std::uint32_t>;

constexpr std::size_t corners_of_triangle = 3;

std::array<float, 3> to_floats(const Vector3d& vector) {
  return {static_cast<float>(vector.x()), static_cast<float>(vector.y()),
          static_cast<float>(vector.z())};
}

/// For each fibre, in parallel.
template <class Function>
void for_each_fiber(const FiberAssembly& fibers, const Function& function) {
  const auto count = static_cast<std::uint32_t>(fibers.fiber_count());
  tbb::parallel_for(Range(0, count), [&function](const Range& range) {
    for (std::uint32_t fiber = range.begin(); fiber != range.end(); ++fiber) {
      function(fiber);
    }
  });
}

void refuse_what_is_too_large(const FiberAssembly& fibers) {
  if (fibers.largest_radius() > FiberMesher::max_drawn) {
    throw std::invalid_argument("a fibre is too thick to draw; radii may be 1e15 m at most");
  }
  const auto is_drawn = [](double value) { return std::abs(value) <= FiberMesher::max_drawn; };
  for (std::size_t i = 0; i < fibers.point_count(); ++i) {
    const Vector3d& point = fibers.points()[i];
    if (!is_drawn(point.x()) || !is_drawn(point.y()) || !is_drawn(point.z())) {
      throw std::invalid_argument("point " + std::to_string(i) +
                                  " is too far away to draw; coordinates may be 1e15 m at most");
    }
  }
}

void refuse_what_is_too_much(std::size_t vertices) {
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

/// Above 0, so that its sign tells left from right.
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

/// Writes the skin of one tube: a pole, rows of corners, and the other pole.
class TubeSkin {
 public:
  TubeSkin(const Vector3d& origin, const std::vector<Eigen::Vector2d>& corners)
      : origin_(origin), corners_(corners) {}

  /// A row per ring, and one on each half sphere.
  static std::size_t rows(std::size_t rings) { return rings + 2; }
  static std::size_t vertex_count(std::size_t rings, std::size_t sides) {
    return rows(rings) * sides + 2;
  }
  /// A triangle per side at each pole, two between rows.
  static std::size_t triangle_count(std::size_t rings, std::size_t sides) {
    return 2 * rows(rings) * sides;
  }

  void write_vertices(const std::vector<TubeRing>& rings, const std::vector<Color>& colors,
                      MeshVertex* next) const {
    const TubeRing& first = rings.front();
    const TubeRing& last = rings.back();
    *next++ = pole(first, -1.0, colors[first.point]);
    next = write_row(collar(first, -1.0), -1.0, colors[first.point], next);
    for (const TubeRing& ring : rings) {
      next = write_row(ring, 0.0, colors[ring.point], next);
    }
    next = write_row(collar(last, 1.0), 1.0, colors[last.point], next);
    *next = pole(last, 1.0, colors[last.point]);
  }

  /// @param vertex number of the tube's first one
  void write_indices(std::size_t rings, std::uint32_t vertex, std::uint32_t* next) const {
    fiber_proximity_ros::for_each_triangle(
        static_cast<std::uint32_t>(rows(rings)), static_cast<std::uint32_t>(corners_.size()),
        [&next, vertex](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
          *next++ = vertex + a;
          *next++ = vertex + b;
          *next++ = vertex + c;
        });
  }

 private:
  MeshVertex pole(const TubeRing& ring, double side, const Color& color) const {
    return {to_floats(ring.center - origin_ + side * ring.radius * ring.tangent),
            to_floats(side * ring.tangent), color, 0.0F};
  }

  /// @param slope what the skin's normal has along the tangent, beside 1 across it
  MeshVertex* write_row(const TubeRing& ring, double slope, const Color& color,
                        MeshVertex* next) const {
    const Vector3d center = ring.center - origin_;
    for (const Eigen::Vector2d& corner : corners_) {
      const Vector3d outward = ring.outward(corner);
      *next++ = {to_floats(center + ring.radius * outward),
                 to_floats((outward + slope * ring.tangent).normalized()), color, 0.0F};
    }
    return next;
  }

  const Vector3d& origin_;
  const std::vector<Eigen::Vector2d>& corners_;
};

}  // namespace

const FiberMesh& FiberMesher::make_ribbons(const FiberAssembly& fibers,
                                           const std::vector<Color>& colors) {
  assert(colors.size() == fibers.point_count());
  refuse_what_is_too_much(edges_of_ribbon * fibers.point_count());
  refuse_what_is_too_large(fibers);
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
  refuse_what_is_too_much(fibers.point_count() * corners.size());  // at least
  refuse_what_is_too_large(fibers);

  rings_.resize(fibers.fiber_count());
  for_each_fiber(fibers, [&](std::uint32_t fiber) {
    fiber_proximity_ros::sweep_tube(fibers, fiber, rings_[fiber]);
  });
  std::vector<std::size_t> first_vertex{0};
  std::vector<std::size_t> first_triangle{0};
  for (const std::vector<TubeRing>& rings : rings_) {
    first_vertex.push_back(first_vertex.back() +
                           TubeSkin::vertex_count(rings.size(), corners.size()));
    first_triangle.push_back(first_triangle.back() +
                             TubeSkin::triangle_count(rings.size(), corners.size()));
  }
  refuse_what_is_too_much(first_vertex.back());

  mesh_.kind = FiberMesh::Kind::tubes;
  mesh_.origin = fibers.point_count() > 0 ? fibers.points().front() : Vector3d::Zero();
  mesh_.vertices.resize(first_vertex.back());
  mesh_.indices.resize(corners_of_triangle * first_triangle.back());
  const TubeSkin skin(mesh_.origin, corners);
  for_each_fiber(fibers, [&](std::uint32_t fiber) {
    const std::vector<TubeRing>& rings = rings_[fiber];
    skin.write_vertices(rings, colors, mesh_.vertices.data() + first_vertex[fiber]);
    skin.write_indices(rings.size(), static_cast<std::uint32_t>(first_vertex[fiber]),
                       mesh_.indices.data() + corners_of_triangle * first_triangle[fiber]);
  });
  mesh_.box = box_of(mesh_.vertices);
  return mesh_;
}

}  // namespace fiber_proximity_rviz

#include "src/environment/mesh_topology.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace fiber {
namespace {

using Eigen::Vector3d;
using Triangle = TriangleMesh::Triangle;
/// By vertex: the first one at the same place.
std::vector<std::uint32_t> weld(const std::vector<Vector3d>& vertices) {
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&vertices](std::uint32_t i, std::uint32_t j) {
    const Vector3d& a = vertices[i];
    const Vector3d& b = vertices[j];
    return std::tie(a.x(), a.y(), a.z(), i) < std::tie(b.x(), b.y(), b.z(), j);
  });
  std::vector<std::uint32_t> welded(vertices.size());
  std::uint32_t first = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || vertices[order[i]] != vertices[first]) {
      first = order[i];
    }
    welded[order[i]] = first;
  }
  return welded;
}

/// Without corners at the same place; others have no edges of their own.
bool has_edges(const Triangle& triangle) {
  return triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0];
}

/// A side of a triangle: edge i from corner i to the next one.
struct Side {
  Side(const Triangle& triangle, std::uint32_t owner_index, std::uint32_t side_index)
      : lower(std::min(triangle[side_index], triangle[(side_index + 1) % 3])),
        upper(std::max(triangle[side_index], triangle[(side_index + 1) % 3])),
        owner(owner_index),
        index(static_cast<std::uint8_t>(side_index)),
        ascends(triangle[side_index] == lower),
        is_proper(has_edges(triangle)) {}

  bool operator<(const Side& other) const {
    return std::tie(lower, upper, owner, index) <
           std::tie(other.lower, other.upper, other.owner, other.index);
  }
  bool shares_edge_with(const Side& other) const {
    return lower == other.lower && upper == other.upper;
  }

  std::uint32_t lower;  // vertices, welded
  std::uint32_t upper;
  std::uint32_t owner;
  std::uint8_t index;
  bool ascends;    // from the lower vertex to the upper one
  bool is_proper;  // of a triangle that has edges
};

/// The sides of all triangles, those of an edge one after the other.
std::vector<Side> sorted_sides(const std::vector<Triangle>& triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint32_t i = 0; i < 3; ++i) {
      sides.emplace_back(triangles[t], t, i);
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

double angle_at(const Vector3d& corner, const Vector3d& next, const Vector3d& previous) {
  const Vector3d a = next - corner;
  const Vector3d b = previous - corner;
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

MeshTopology::MeshTopology(const std::vector<Vector3d>& vertices,
                           const std::vector<Triangle>& triangles)
    : normals_(triangles.size()), corner_normals_(vertices.size(), Vector3d::Zero()) {
  const std::vector<std::uint32_t> places = weld(vertices);
  double volume = 0.0;  // six times that inside
  welded_.reserve(triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const Triangle& welded = welded_.emplace_back(
        Triangle{places[triangles[t][0]], places[triangles[t][1]], places[triangles[t][2]]});
    const Vector3d& a = vertices[welded[0]];
    const Vector3d& b = vertices[welded[1]];
    const Vector3d& c = vertices[welded[2]];
    normals_[t].face = (b - a).cross(c - a).stableNormalized();
    normals_[t].edges.fill(normals_[t].face);
    volume += (a - vertices[0]).cross(b - vertices[0]).dot(c - vertices[0]);
    for (std::size_t i = 0; i < 3; ++i) {
      const double angle = angle_at(vertices[welded[i]], vertices[welded[(i + 1) % 3]],
                                    vertices[welded[(i + 2) % 3]]);
      corner_normals_[welded[i]] += angle * normals_[t].face;
    }
  }
  join_triangles();
  outwards_ = volume < 0.0 ? -1.0 : 1.0;
}

/// Gives each side of a triangle the normal of its edge, and looks whether all edges are closed.
void MeshTopology::join_triangles() {
  const std::vector<Side> sides = sorted_sides(welded_);
  for (auto begin = sides.begin(), end = begin; begin != sides.end(); begin = end) {
    // The first triangles on the two sides of the edge.
    const Side* ascending = nullptr;
    const Side* descending = nullptr;
    for (; end != sides.end() && end->shares_edge_with(*begin); ++end) {
      if (end->is_proper) {
        const Side*& first = end->ascends ? ascending : descending;
        is_closed_ = is_closed_ && first == nullptr;  // else two triangles on the same side
        first = first == nullptr ? &*end : first;
      }
    }
    for (auto side = begin; side != end; ++side) {
      const Side* other = side->ascends ? descending : ascending;
      if (other != nullptr) {
        normals_[side->owner].edges[side->index] += normals_[other->owner].face;
      } else if (side->is_proper) {
        is_closed_ = false;
      }
    }
  }
}

Vector3d MeshTopology::normal(std::uint32_t triangle, const TriangleFeature& feature) const {
  const auto index = static_cast<std::size_t>(feature.index);
  switch (feature.kind) {
    case TriangleFeature::Kind::EDGE:
      return outwards_ * normals_[triangle].edges[index];
    case TriangleFeature::Kind::CORNER:
      return outwards_ * corner_normals_[welded_[triangle][index]];
    case TriangleFeature::Kind::FACE:
      break;
  }
  return outwards_ * normals_[triangle].face;
}

}  // namespace fiber

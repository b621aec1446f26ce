#include "mesh_topology.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

namespace fiber {
namespace {

using Eigen::Vector3d;
using Triangle = TriangleMesh::Triangle;
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// By vertex: the first one at the same place.
std::vector<std::uint32_t> weld(const std::vector<Vector3d>& vertices) {
  std::map<std::tuple<double, double, double>, std::uint32_t> places;
  std::vector<std::uint32_t> welded;
  welded.reserve(vertices.size());
  for (const Vector3d& vertex : vertices) {
    const auto index = static_cast<std::uint32_t>(welded.size());
    welded.push_back(
        places.emplace(std::tuple(vertex.x(), vertex.y(), vertex.z()), index).first->second);
  }
  return welded;
}

/// Without corners at the same place; others have no edges of their own.
bool has_edges(const Triangle& triangle) {
  return triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0];
}

Edge edge_of(const Triangle& triangle, std::size_t i) {
  return {triangle[i], triangle[(i + 1) % 3]};
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
  std::map<Edge, std::uint32_t> owners;
  double volume = 0.0;  // six times that inside
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const Triangle& welded = welded_.emplace_back(
        Triangle{places[triangles[t][0]], places[triangles[t][1]], places[triangles[t][2]]});
    const Vector3d& a = vertices[welded[0]];
    const Vector3d& b = vertices[welded[1]];
    const Vector3d& c = vertices[welded[2]];
    normals_[t].face = (b - a).cross(c - a).stableNormalized();
    volume += (a - vertices[0]).cross(b - vertices[0]).dot(c - vertices[0]);
    for (std::size_t i = 0; i < 3; ++i) {
      const double angle = angle_at(vertices[welded[i]], vertices[welded[(i + 1) % 3]],
                                    vertices[welded[(i + 2) % 3]]);
      corner_normals_[welded[i]] += angle * normals_[t].face;
      if (has_edges(welded) && !owners.emplace(edge_of(welded, i), t).second) {
        is_closed_ = false;  // two triangles on the same side of an edge
      }
    }
  }
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Edge edge = edge_of(welded_[t], i);
      const auto other = owners.find({edge.second, edge.first});
      normals_[t].edges[i] = normals_[t].face;
      if (other != owners.end()) {
        normals_[t].edges[i] += normals_[other->second].face;
      } else if (has_edges(welded_[t])) {
        is_closed_ = false;
      }
    }
  }
  outwards_ = volume < 0.0 ? -1.0 : 1.0;
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

#include "fiber_proximity/environment/triangle_mesh.hpp"

#include <fcl/geometry/bvh/BVH_model.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <stdexcept>
#include <string>
#include <utility>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/environment/mesh_topology.hpp"
#include "src/environment/triangle_distance.hpp"
#include "src/geometry/norm.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;
using Triangle = TriangleMesh::Triangle;
using Model = fcl::BVHModel<fcl::AABBd>;

constexpr double infinity = std::numeric_limits<double>::infinity();

void check(const std::vector<Vector3d>& vertices, const std::vector<Triangle>& triangles) {
  if (triangles.empty() || triangles.size() > TriangleMesh::max_triangles) {
    throw std::invalid_argument("the mesh has " + std::to_string(triangles.size()) +
                                " triangles, it must have at least 1 and at most " +
                                std::to_string(TriangleMesh::max_triangles));
  }
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (!vertices[i].unaryExpr(&FiberAssembly::is_valid_coordinate).all()) {
      throw std::invalid_argument("vertex " + std::to_string(i) +
                                  " of the mesh: " + FiberAssembly::coordinate_rule);
    }
  }
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const std::uint32_t vertex : triangles[t]) {
      if (vertex >= vertices.size()) {
        throw std::invalid_argument("triangle " + std::to_string(t) + " of the mesh has vertex " +
                                    std::to_string(vertex) + ", there are " +
                                    std::to_string(vertices.size()));
      }
    }
  }
}

void build(const std::vector<Vector3d>& vertices, const std::vector<Triangle>& triangles,
           Model& model) {
  std::vector<fcl::Triangle> indices;
  indices.reserve(triangles.size());
  for (const Triangle& triangle : triangles) {
    indices.emplace_back(triangle[0], triangle[1], triangle[2]);
  }
  const bool built = model.beginModel() == fcl::BVH_OK &&
                     model.addSubModel(vertices, indices) == fcl::BVH_OK &&
                     model.endModel() == fcl::BVH_OK;
  if (!built) {
    throw std::invalid_argument("FCL cannot build a tree over the mesh");
  }
}

/// Least signed distance along a segment when nothing is known of it but that it changes by no more
/// than the length between two points (S. A. Piyavskii 1972, "An algorithm for finding the absolute
/// extremum of a function"). Ends when it is known to a sixteenth of itself or of the segment's
/// length, whichever is more; `lower` is certain.
/// @param function AxisDistance of a parameter s
/// @param length   [m] of the segment
/// @param start    the distance at one point of it
template <class Function>
AxisDistance lipschitz_minimum(const Function& function, double length, const AxisDistance& start) {
  struct Interval {
    double begin, end;
    double begin_value, end_value;  // [m]
    double lower;                   // [m] no value between is less

    bool operator<(const Interval& other) const { return lower > other.lower; }
  };
  constexpr double tolerance = 1.0 / 16.0;
  AxisDistance best = start;
  const auto look = [&](double s) {
    AxisDistance found = function(s);
    found.s = s;
    if (found.distance < best.distance) {
      best = found;
    }
    return found.distance;
  };
  std::priority_queue<Interval> intervals;
  const auto add = [&](double begin, double end, double begin_value, double end_value) {
    intervals.push({begin, end, begin_value, end_value,
                    0.5 * (begin_value + end_value - length * (end - begin))});
  };
  const double begin_value = look(0.0);
  add(0.0, 1.0, begin_value, look(1.0));
  for (;;) {
    const Interval lowest = intervals.top();
    const double middle = 0.5 * (lowest.begin + lowest.end);
    const double enough = tolerance * std::max(std::abs(best.distance), length);
    if (best.distance - lowest.lower <= enough || !(lowest.begin < middle && middle < lowest.end)) {
      best.lower = std::min(best.distance, lowest.lower);
      return best;
    }
    intervals.pop();
    const double value = look(middle);
    add(lowest.begin, middle, lowest.begin_value, value);
    add(middle, lowest.end, value, lowest.end_value);
  }
}

}  // namespace

/// The triangles behind FCL's tree of boxes. FCL's own distances from it are not used: GJK may
/// fail, and depths are zero.
class TriangleMesh::Surface {
 public:
  Surface(const std::vector<Vector3d>& vertices, const std::vector<Triangle>& triangles)
      : vertices_(vertices), triangles_(triangles), topology_(vertices, triangles) {
    build(vertices, triangles, model_);
  }

  bool is_closed() const { return topology_.is_closed(); }

  /// Where the segment is nearest to the surface, infinitely far beyond the bound [m].
  AxisDistance nearest(const Vector3d& p0, const Vector3d& p1, double bound) const {
    SegmentTriangle best;
    best.distance = infinity;
    std::uint32_t owner = 0;
    search(box_around(p0, p1), bound, [&](std::uint32_t triangle, double& most) {
      const SegmentTriangle found = segment_triangle(p0, p1, corners(triangle));
      if (found.distance < best.distance && found.distance <= most) {
        best = found;
        owner = triangle;
        most = found.distance;
      }
    });
    AxisDistance distance{best.s, best.distance, best.distance, Vector3d::UnitX()};
    if (best.distance > 0.0 && best.distance < infinity) {
      distance.gradient = (p0 + best.s * (p1 - p0) - best.nearest) / best.distance;
    } else if (best.distance == 0.0) {
      // It passes through: away to the side where more of it is.
      const Vector3d normal = topology_.normal(owner, {});
      distance.gradient = normal.dot(0.5 * (p0 + p1) - best.nearest) < 0.0 ? -normal : normal;
    }
    return distance;
  }

  /// Signed distance of a point, of a closed mesh, with its gradient.
  AxisDistance signed_distance(const Vector3d& point) const {
    PointTriangle best;
    std::uint32_t owner = 0;
    double least = infinity;
    search(box_around(point, point), infinity, [&](std::uint32_t triangle, double& most) {
      const PointTriangle found = nearest_on_triangle(point, corners(triangle));
      const double distance = norm_of(point - found.nearest);
      if (distance < least) {
        best = found;
        owner = triangle;
        least = most = distance;
      }
    });
    const Vector3d out = topology_.normal(owner, best.feature);
    const double sign = out.dot(point - best.nearest) < 0.0 ? -1.0 : 1.0;
    AxisDistance distance{0.0, sign * least, sign * least, out.stableNormalized()};
    if (least > 0.0) {
      distance.gradient = sign / least * (point - best.nearest);
    }
    return distance;
  }

  template <class Visit>
  void visit_near(const WorldBox& box, double within, const Visit& visit) const {
    search(box, within, [&](std::uint32_t triangle, double&) { visit(corners(triangle)); });
  }

 private:
  TriangleCorners corners(std::uint32_t triangle) const {
    const Triangle& indices = triangles_[triangle];
    return {vertices_[indices[0]], vertices_[indices[1]], vertices_[indices[2]]};
  }

  /// Larger than the segment by a few roundings, so that boxes are never further than what is in
  /// them.
  static WorldBox box_around(const Vector3d& p0, const Vector3d& p1) {
    const Vector3d padding = 0x1p-50 * p0.cwiseAbs().cwiseMax(p1.cwiseAbs());
    return {p0.cwiseMin(p1) - padding, p0.cwiseMax(p1) + padding};
  }

  /// Looks at triangles near a box, nearer boxes of the tree first, while these are within the
  /// bound [m], which the looks may lower.
  template <class Look>
  void search(const WorldBox& box, double bound, const Look& look) const {
    search(0, box, bound, look);
  }

  template <class Look>
  void search(int index, const WorldBox& box, double& bound, const Look& look) const {
    const auto& node = model_.getBV(index);
    if (node.isLeaf()) {
      look(static_cast<std::uint32_t>(node.primitiveId()), bound);
      return;
    }
    std::pair<double, int> near{distance(box, node.leftChild()), node.leftChild()};
    std::pair<double, int> far{distance(box, node.rightChild()), node.rightChild()};
    if (far.first < near.first) {
      std::swap(near, far);
    }
    for (const auto& [least, child] : {near, far}) {
      if (least <= bound) {
        search(child, box, bound, look);
      }
    }
  }

  double distance(const WorldBox& box, int node) const {
    const fcl::AABBd& bounds = model_.getBV(node).bv;
    return box.exteriorDistance(WorldBox(bounds.min_, bounds.max_));
  }

  const std::vector<Vector3d>& vertices_;
  const std::vector<Triangle>& triangles_;
  MeshTopology topology_;
  Model model_;
};

TriangleMesh::TriangleMesh(std::vector<Vector3d> vertices, std::vector<Triangle> triangles)
    : vertices_(std::move(vertices)), triangles_(std::move(triangles)) {
  check(vertices_, triangles_);
  for (const Vector3d& vertex : vertices_) {
    box_.extend(vertex);
  }
  surface_ = std::make_unique<Surface>(vertices_, triangles_);
}

TriangleMesh::~TriangleMesh() = default;

bool TriangleMesh::is_closed() const { return surface_->is_closed(); }

AxisDistance TriangleMesh::axis_distance(const Vector3d& p0, const Vector3d& p1,
                                         double bound) const {
  if (!is_closed()) {
    return surface_->nearest(p0, p1, bound);
  }
  const double length = (p1 - p0).stableNorm();
  // Where it all but touches the surface it may pass through an edge unseen.
  const double touching = 0x1p-40 * length;
  AxisDistance nearest = surface_->nearest(p0, p1, std::max(bound, touching));
  const AxisDistance at = nearest.distance <= touching ? nearest
                          : box_.contains(p0)          ? surface_->signed_distance(p0)
                                                       : nearest;
  if (at.distance > touching) {
    return nearest;
  }
  return lipschitz_minimum([&](double s) { return surface_->signed_distance(p0 + s * (p1 - p0)); },
                           length, at);
}

void TriangleMesh::visit_near(const WorldBox& box, double within,
                              const std::function<void(const TriangleCorners&)>& visit) const {
  surface_->visit_near(box, within, visit);
}

}  // namespace fiber

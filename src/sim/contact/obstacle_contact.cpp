#include "src/sim/contact/obstacle_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fiber_proximity/environment/occupancy_octree.hpp"
#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "src/sim/contact/flat_parts.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

using MeshPointer = std::shared_ptr<const TriangleMesh>;
using OctreePointer = std::shared_ptr<const OccupancyOctree>;

// The same questions of a triangle as of the solids.

PointDistance point_distance(const TriangleCorners& triangle, const Vector3d& point) {
  const Vector3d way = point - nearest_on_triangle(point, triangle).nearest;
  const double distance = way.norm();
  return {distance, distance > 0.0 ? Vector3d(way / distance) : Vector3d::UnitZ()};
}

double nearest_parameter(const TriangleCorners& triangle, const Vector3d& p0, const Vector3d& p1) {
  return segment_triangle(p0, p1, triangle).s;
}

template <class Solid>
double nearest_parameter(const Solid& solid, const Vector3d& p0, const Vector3d& p1) {
  return axis_distance(solid, p0, p1).s;
}

/// Calls look(part) for the pieces whose boxes are within a distance of a segment, in a shape's
/// frame.
template <class Look>
void visit_near_parts(const Shape& shape, const Vector3d& p0, const Vector3d& p1, double within,
                      const Look& look) {
  WorldBox box(p0);
  box.extend(p1);
  if (const auto* const mesh = std::get_if<MeshPointer>(&shape)) {
    (*mesh)->visit_near(box, within, [&look](const TriangleCorners& triangle) { look(triangle); });
  } else if (const auto* const octree = std::get_if<OctreePointer>(&shape)) {
    const auto look_at = [&](const Vector3d& center) {
      look(ObstaclePiece::Cell{center, (*octree)->resolution()});
    };
    (*octree)->visit_near(box, within, std::cref(look_at));
  } else {
    look(std::monostate{});
  }
}

}  // namespace

bool ObstacleShape::is_convex() const {
  return !std::holds_alternative<MeshPointer>(*shape) &&
         !std::holds_alternative<OctreePointer>(*shape);
}

/// Calls ask(solid, center) for the convex solid that the piece is, and where its centre is in the
/// frame of the shape.
template <class Ask>
auto ObstaclePiece::ask_solid(const Ask& ask) const {
  using Answer = decltype(ask(BoxShape{}, Vector3d()));
  if (const auto* const triangle = std::get_if<TriangleCorners>(&part_)) {
    return ask(*triangle, Vector3d::Zero());
  }
  if (const auto* const cell = std::get_if<Cell>(&part_)) {
    return ask(BoxShape{Vector3d::Constant(cell->size)}, cell->center);
  }
  return std::visit(
      [&ask](const auto& solid) -> Answer {
        using Solid = std::decay_t<decltype(solid)>;
        if constexpr (std::is_same_v<Solid, MeshPointer> || std::is_same_v<Solid, OctreePointer>) {
          assert(false);  // these are in parts
          return {};
        } else {
          return ask(solid, Vector3d::Zero());
        }
      },
      *shape_->shape);
}

double ObstaclePiece::nearest_parameter(const Vector3d& p0, const Vector3d& p1) const {
  const Vector3d q0 = shape_->to_shape * p0;
  const Vector3d q1 = shape_->to_shape * p1;
  return ask_solid([&](const auto& solid, const Vector3d& center) {
    return fiber::nearest_parameter(solid, q0 - center, q1 - center);
  });
}

PointDistance ObstaclePiece::distance_from(const Vector3d& point) const {
  const Vector3d local = shape_->to_shape * point;
  PointDistance found = ask_solid([&local](const auto& solid, const Vector3d& center) {
    return point_distance(solid, local - center);
  });
  found.gradient = shape_->pose.linear() * found.gradient;
  return found;
}

std::optional<double> ObstaclePiece::middle_of_flat(const Vector3d& p0, const Vector3d& p1) const {
  const Vector3d q0 = shape_->to_shape * p0;
  const Vector3d q1 = shape_->to_shape * p1;
  return ask_solid([&](const auto& solid, const Vector3d& center) {
    // The first of flats that are as near: their points are not to change with each step.
    const double rounding = 1e-6 * (p1 - p0).norm();
    std::optional<double> found;
    double least = std::numeric_limits<double>::infinity();
    const FlatParts flats = parts_over_flats(solid, q0 - center, q1 - center);
    for (std::size_t i = 0; i < flats.count; ++i) {
      const EdgePart& part = flats.parts[i];
      if (part.first > 0.0 && part.last < 1.0 && part.first < part.last) {
        const double middle = 0.5 * (part.first + part.last);
        const Vector3d point = (1.0 - middle) * q0 + middle * q1;
        const double distance = point_distance(solid, point - center).distance;
        if (distance < least - rounding) {
          least = distance;
          found = middle;
        }
      }
    }
    return found;
  });
}

void visit_near_pieces(const ObstacleShape& shape, const Vector3d& p0, const Vector3d& p1,
                       double within, const std::function<void(const ObstaclePiece&)>& visit) {
  const Vector3d q0 = shape.to_shape * p0;
  const Vector3d q1 = shape.to_shape * p1;
  visit_near_parts(*shape.shape, q0, q1, within, [&](const ObstaclePiece::Part& part) {
    const ObstaclePiece piece(shape, part);
    const double s = p0 == p1 ? 0.0 : piece.nearest_parameter(p0, p1);
    if (piece.distance_from((1.0 - s) * p0 + s * p1).distance <= within) {
      visit(piece);
    }
  });
}

namespace {

/// A lower bound of the distance along an edge, linear from one end to the other.
struct Line {
  double first;
  double last;

  double at(double s) const { return first + s * (last - first); }
};

/// The lower bound for the whole edge that the distance and its gradient at a place give, as
/// distances from convex pieces are convex.
/// @param moved by which its ends have moved [m]
Line tangent(double s, const PointDistance& found, const Vector3d& edge,
             const std::array<Vector3d, 2>& moved = {Vector3d::Zero(), Vector3d::Zero()}) {
  return {found.distance + found.gradient.dot(moved[0] - s * edge),
          found.distance + found.gradient.dot(moved[1] + (1.0 - s) * edge)};
}

/// The least distance along an edge by two lower bounds, of which the greater holds at each place.
double min_on_edge(const Line& a, const Line& b) {
  const double min_at_ends = std::min(std::max(a.first, b.first), std::max(a.last, b.last));
  const double at_first = a.first - b.first;
  const double at_last = a.last - b.last;
  const bool cross = at_first * at_last < 0.0;
  return cross ? std::min(min_at_ends, a.at(at_first / (at_first - at_last))) : min_at_ends;
}

Smoothstep weight_factor(const ObstacleContact& contact, const ObstacleDistance& distance,
                         std::size_t end) {
  const double further = distance.ends[end].distance - distance.nearest.distance;
  return Smoothstep(std::max(0.0, further) / contact.barrier.width());
}

/// The nearest point of an edge that turns about it moves along the edge, by the less the more the
/// distance grows there: like that of a parabola through what the farther end's is.
double turning_of(const ObstacleContact& contact, const ObstacleDistance& distance,
                  double pressure) {
  if (contact.point) {
    return 0.0;
  }
  const double length = contact.part.last - contact.part.first;
  const auto bend = [&](std::size_t end) {
    const double way = (distance.s - static_cast<double>(end)) * length;
    return 2.0 * (distance.ends[end].distance - distance.nearest.distance) / (way * way);
  };
  const double larger = std::max(bend(0), bend(1));
  return larger > 0.0 ? pressure / larger : 0.0;
}

}  // namespace

bool stays_above(double floor, const ObstacleDistance& distance, const Vector3d& edge,
                 const std::array<Vector3d, 2>& ways) {
  std::array<EdgePart, 3> safe;
  const std::size_t count = distance.weight > 0.0 ? 3 : 2;
  const auto keep_above = [&](EdgePart& part, double s, const PointDistance& found) {
    for (const Line& line : {tangent(s, found, edge), tangent(s, found, edge, ways)}) {
      part.keep_positive(line.first - floor, line.last - floor);
    }
  };
  keep_above(safe[0], 0.0, distance.ends[0]);
  keep_above(safe[1], 1.0, distance.ends[1]);
  if (count == 3) {
    keep_above(safe[2], distance.s, distance.nearest);
  }
  double reached = 0.0;
  for (std::size_t round = 0; round < count; ++round) {
    for (std::size_t i = 0; i < count; ++i) {
      if (safe[i].first <= reached) {
        reached = std::max(reached, safe[i].last);
      }
    }
  }
  return reached >= 1.0;
}

namespace {

/// Whether the distances of the ends show that the edge has no contact of its own: mostly they do.
/// The distance is a lower bound then.
bool has_no_weight(const ObstacleContact& contact, const Vector3d& edge,
                   ObstacleDistance& distance) {
  const Line from_first = tangent(0.0, distance.ends[0], edge);
  const Line from_last = tangent(1.0, distance.ends[1], edge);
  const double bound = min_on_edge(from_first, from_last);
  const double nearer_end = std::min(distance.ends[0].distance, distance.ends[1].distance);
  constexpr double rounding = 1e-7;
  if (bound >= contact.barrier.outer || bound >= nearer_end - rounding * contact.barrier.width()) {
    distance.nearest.distance = bound;
    distance.weight = 0.0;
    return true;
  }
  return false;
}

}  // namespace

ObstacleDistance obstacle_distance(const ObstacleContact& contact,
                                   const std::vector<Vector3d>& positions) {
  ObstacleDistance distance;
  const auto [p0, p1] = contact.ends(positions);
  if (contact.part.is_point()) {
    distance.nearest = contact.piece.distance_from(p0);
    return distance;
  }
  distance.ends = {contact.piece.distance_from(p0), contact.piece.distance_from(p1)};
  if (!contact.point && has_no_weight(contact, p1 - p0, distance)) {
    return distance;
  }
  distance.s = contact.point ? *contact.point : contact.piece.nearest_parameter(p0, p1);
  distance.nearest = contact.piece.distance_from((1.0 - distance.s) * p0 + distance.s * p1);
  distance.weight =
      weight_factor(contact, distance, 0).value * weight_factor(contact, distance, 1).value;
  return distance;
}

double obstacle_contact(const ObstacleContact& contact, const ObstacleDistance& distance,
                        DistanceTerms* terms) {
  const Barrier& barrier = contact.barrier;
  const double weight = distance.weight;
  if (weight == 0.0 || distance.nearest.distance >= barrier.outer) {
    return 0.0;
  }
  const WeightedBarrier weighted(barrier, distance.nearest.distance, weight);
  const double energy = weighted.energy();
  if (terms == nullptr || !(energy < std::numeric_limits<double>::infinity())) {
    return energy;
  }
  const bool is_edge = !contact.part.is_point();
  std::array<Smoothstep, 2> steps{Smoothstep(1.0), Smoothstep(1.0)};
  std::array<double, 2> cosines{};
  for (std::size_t end = 0; is_edge && end < 2; ++end) {
    steps[end] = weight_factor(contact, distance, end);
    cosines[end] = distance.ends[end].gradient.dot(distance.nearest.gradient);
  }
  WeightedSlopes<2> by = weighted.slopes(steps, cosines);
  // Where the weight falls, the edge is less stiff than nothing. Half of the stiffness of the
  // contacts that the ends have makes up for it, as far as it goes: an end has two edges.
  Vector3d borrowed = Vector3d::Zero();
  const bool is_weight_changing = steps[0].slope > 0.0 || steps[1].slope > 0.0;
  for (std::size_t end = 0; is_weight_changing && end < 2; ++end) {
    const double of_end = distance.ends[end].distance;
    if (of_end < barrier.outer && of_end > barrier.inner) {
      borrowed[static_cast<Eigen::Index>(end + 1)] = 0.5 * barrier.curvature(of_end);
    }
  }
  Vector3d curvatures = by.hessian.diagonal();
  if (is_weight_changing) {
    curvatures = by.hessian.rowwise().sum();
    by.hessian.diagonal() += borrowed;
    terms->couple(by.hessian);
  }
  terms->push_back({contact.part.on_edge(distance.s), 0.0, distance.nearest.gradient,
                    by.gradient[0], curvatures[0], by.pressure,
                    turning_of(contact, distance, by.pressure)});
  for (int end = 0; is_weight_changing && end < 2; ++end) {
    terms->push_back({contact.part.on_edge(end), 0.0,
                      distance.ends[static_cast<std::size_t>(end)].gradient, by.gradient[end + 1],
                      curvatures[end + 1], 0.0, 0.0, 0.0, borrowed[end + 1]});
  }
  return energy;
}

double bounded_share(const ObstacleContact& contact, const ObstacleDistance& distance,
                     const std::vector<Vector3d>& positions,
                     const std::vector<Vector3d>& displacements, double part, double share) {
  const double max_loss = part * (distance.nearest.distance - contact.barrier.min_distance());
  if (contact.point) {
    const double s = contact.part.on_edge(distance.s);
    const double approach =
        -distance.nearest.gradient.dot(point_at(displacements, contact.edge, s));
    return approach * share > max_loss ? std::max(0.0, max_loss / approach) : share;
  }
  const std::array<Vector3d, 2> ends = contact.ends(positions);
  const std::array<Vector3d, 2> step = contact.ends(displacements);
  const double longest = std::sqrt(std::max(step[0].squaredNorm(), step[1].squaredNorm()));
  if (longest * share <= max_loss) {
    return share;
  }
  const double floor = distance.nearest.distance - max_loss;
  constexpr int max_halvings = 20;
  for (int i = 0; i < max_halvings; ++i) {
    if (stays_above(floor, distance, ends[1] - ends[0], {share * step[0], share * step[1]})) {
      return share;
    }
    share *= 0.5;
  }
  return longest * share <= max_loss ? share : 0.0;
}

}  // namespace fiber

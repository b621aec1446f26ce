#include "fiber_proximity/sim/edge_share.hpp"

#include <algorithm>

namespace fiber {

using Eigen::Vector3d;

namespace {

/// Of a contact at a point of an edge near its end node: none at the node, all from where on the
/// target is not over the next edge.
/// @param next   the next edge's other node [m]
/// @param across from the point to the target [m]
/// @param other  along which the target slides, of unit length; zero for a target that does not
double end_share(const Vector3d& next, const Vector3d& node, const Vector3d& point,
                 const Vector3d& across, const Vector3d& other) {
  // Seen along the target's edge, which is a point then.
  const Vector3d beyond = next - node;
  const Vector3d rest = node - point;
  const double over_next = across.dot(beyond);
  const double ahead = rest.dot(beyond) - other.dot(rest) * other.dot(beyond);
  // The target is over the next edge up to where these are the same.
  return over_next > 0.0 && ahead < over_next ? std::max(0.0, ahead / over_next) : 1.0;
}

}  // namespace

double edge_share(const Rods& rods, std::uint32_t rod, std::uint32_t edge, double parameter,
                  const Vector3d& target, const Vector3d& other) {
  const bool has_next = edge + 2 < rods.end(rod);
  const bool has_previous = edge > rods.first(rod);
  const std::vector<Vector3d>& x = rods.positions;
  if (parameter >= 1.0) {
    return has_next ? 0.0 : 1.0;
  }
  if (parameter <= 0.0) {
    return has_previous && (x[edge - 1] - x[edge]).dot(target - x[edge]) > 0.0 ? 0.0 : 1.0;
  }
  const Vector3d point = x[edge] + parameter * (x[edge + 1] - x[edge]);
  const Vector3d across = target - point;
  const double before = has_previous ? end_share(x[edge - 1], x[edge], point, across, other) : 1.0;
  const double after = has_next ? end_share(x[edge + 2], x[edge + 1], point, across, other) : 1.0;
  return std::min(before, after);
}

}  // namespace fiber

#include "src/sim/contact/obstacle_contact.hpp"

#include <algorithm>
#include <limits>

#include "src/sim/contact/weighted_barrier.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// What is known of distances along an edge: at a place, and how it grows from there.
struct Tangent {
  double s;
  PointDistance found;

  /// At another place, when the ends of the edge have moved.
  double at(double t, const Vector3d& edge, const Vector3d& moved) const {
    return found.distance + found.gradient.dot((t - s) * edge + moved);
  }
};

/// The least distance that tangents promise along an edge from p0 to p1, and where it is.
struct Promise {
  double distance = std::numeric_limits<double>::infinity();
  double s = 0.0;
};

/// @param moved of the ends [m]
Promise least_promise(const Tangent* tangents, std::size_t count, const Vector3d& edge,
                      const std::array<Vector3d, 2>& moved) {
  const auto promise = [&](double t) {
    const Vector3d way = (1.0 - t) * moved[0] + t * moved[1];
    double most = -std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < count; ++i) {
      most = std::max(most, tangents[i].at(t, edge, way));
    }
    return most;
  };
  Promise least;
  const auto try_at = [&](double t) {
    if (t >= 0.0 && t <= 1.0 && promise(t) < least.distance) {
      least = {promise(t), t};
    }
  };
  try_at(0.0);
  try_at(1.0);
  // Where two of these linear functions meet.
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      const double at_first =
          tangents[i].at(0.0, edge, moved[0]) - tangents[j].at(0.0, edge, moved[0]);
      const double at_last =
          tangents[i].at(1.0, edge, moved[1]) - tangents[j].at(1.0, edge, moved[1]);
      if (at_first * at_last < 0.0) {
        try_at(at_first / (at_first - at_last));
      }
    }
  }
  return least;
}

std::uint32_t node_of(const ObstacleContact& contact) {
  return contact.edge + (contact.part == ObstacleContact::Part::LAST_NODE ? 1 : 0);
}

Ramp ramp_of(const ObstacleContact& contact, const ObstacleDistance& distance, std::size_t end) {
  const double further = distance.ends[end].distance - distance.nearest.distance;
  return Ramp(std::max(0.0, further) / contact.barrier.width());
}

/// The nearest point of an edge that turns about it moves along the edge, by the less the more the
/// distance grows there: like that of a parabola through what the farther end's is.
double turning_of(const ObstacleContact& contact, const ObstacleDistance& distance,
                  double pressure) {
  if (contact.part != ObstacleContact::Part::EDGE) {
    return 0.0;
  }
  const auto bend = [&](std::size_t end) {
    const double way = distance.s - static_cast<double>(end);
    return 2.0 * (distance.ends[end].distance - distance.nearest.distance) / (way * way);
  };
  const double most = std::max(bend(0), bend(1));
  return most > 0.0 ? pressure / most : 0.0;
}

}  // namespace

ObstacleDistance obstacle_distance(const ObstacleContact& contact,
                                   const std::vector<Vector3d>& positions) {
  ObstacleDistance distance;
  if (contact.part != ObstacleContact::Part::EDGE) {
    distance.nearest = contact.piece.distance_from(positions[node_of(contact)]);
    return distance;
  }
  const Vector3d& p0 = positions[contact.edge];
  const Vector3d& p1 = positions[contact.edge + 1];
  distance.ends = {contact.piece.distance_from(p0), contact.piece.distance_from(p1)};
  // Mostly the ends tell that the edge has no part of its own.
  const std::array<Tangent, 2> tangents{{{0.0, distance.ends[0]}, {1.0, distance.ends[1]}}};
  const Promise promise = least_promise(tangents.data(), tangents.size(), p1 - p0,
                                        {Vector3d::Zero(), Vector3d::Zero()});
  const double nearer_end = std::min(distance.ends[0].distance, distance.ends[1].distance);
  constexpr double rounding = 1e-7;
  if (promise.distance >= contact.barrier.outer ||
      promise.distance >= nearer_end - rounding * contact.barrier.width()) {
    distance.nearest.distance = promise.distance;
    distance.weight = 0.0;
    return distance;
  }
  distance.s = contact.piece.nearest_parameter(p0, p1);
  distance.nearest = contact.piece.distance_from((1.0 - distance.s) * p0 + distance.s * p1);
  distance.weight = ramp_of(contact, distance, 0).value * ramp_of(contact, distance, 1).value;
  return distance;
}

double obstacle_contact(const ObstacleContact& contact, const ObstacleDistance& distance,
                        std::vector<DistanceTerm>* terms) {
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
  const bool is_edge = contact.part == ObstacleContact::Part::EDGE;
  std::array<Ramp, 2> ramps{Ramp(1.0), Ramp(1.0)};
  std::array<double, 2> cosines{};
  for (std::size_t end = 0; is_edge && end < 2; ++end) {
    ramps[end] = ramp_of(contact, distance, end);
    cosines[end] = distance.ends[end].gradient.dot(distance.nearest.gradient);
  }
  const WeightedSlopes<2> by = weighted.slopes(ramps, cosines);
  for (std::size_t end = 0; end < 2; ++end) {
    if (ramps[end].slope > 0.0) {
      terms->push_back({static_cast<double>(end), 0.0, distance.ends[end].gradient,
                        by.end_slopes[end], by.end_curvatures[end], 0.0});
    }
  }
  const double at_node = contact.part == ObstacleContact::Part::LAST_NODE ? 1.0 : 0.0;
  terms->push_back({is_edge ? distance.s : at_node, 0.0, distance.nearest.gradient, by.slope,
                    by.curvature, by.pressure, turning_of(contact, distance, by.pressure)});
  return energy;
}

double bounded_share(const ObstacleContact& contact, const ObstacleDistance& distance,
                     const std::vector<Vector3d>& positions,
                     const std::vector<Vector3d>& displacements, double part, double share) {
  const double least = contact.barrier.least();
  const double room = part * (distance.nearest.distance - least);
  if (contact.part != ObstacleContact::Part::EDGE) {
    const double approach = -distance.nearest.gradient.dot(displacements[node_of(contact)]);
    return approach * share > room ? std::max(0.0, room / approach) : share;
  }
  const std::uint32_t edge = contact.edge;
  const std::array<Vector3d, 2> ways{displacements[edge], displacements[edge + 1]};
  const double longest = std::sqrt(std::max(ways[0].squaredNorm(), ways[1].squaredNorm()));
  if (longest * share <= room) {
    return share;
  }
  const std::array<Tangent, 3> tangents{
      {{0.0, distance.ends[0]}, {1.0, distance.ends[1]}, {distance.s, distance.nearest}}};
  const std::size_t count = distance.weight > 0.0 ? 3 : 2;
  const double floor = distance.nearest.distance - room;
  constexpr int most_halvings = 20;
  for (int i = 0; i < most_halvings; ++i) {
    const Promise promise =
        least_promise(tangents.data(), count, positions[edge + 1] - positions[edge],
                      {share * ways[0], share * ways[1]});
    if (promise.distance >= floor) {
      return share;
    }
    share *= 0.5;
  }
  return longest * share <= room ? share : 0.0;
}

}  // namespace fiber

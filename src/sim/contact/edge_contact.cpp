#include "src/sim/contact/edge_contact.hpp"

#include <algorithm>
#include <limits>
#include <optional>

namespace fiber {

using Eigen::Vector3d;
using Eigen::Vector4d;
using Vector5d = WeightedSlopes<4>::Vector;
using Square5d = WeightedSlopes<4>::Square;

namespace {

/// The point of the other edge that is nearest to an end of one edge.
struct EndDistance {
  double parameter;  // on the other edge
  Vector3d delta;    // from there to the end [m]
  double distance;   // [m]
};

EndDistance end_distance(const Vector3d& point, const Vector3d& first, const Vector3d& last) {
  const Vector3d edge = last - first;
  const double square = edge.squaredNorm();
  const double along = (point - first).dot(edge);
  const double parameter = square > 0.0 ? std::clamp(along / square, 0.0, 1.0) : 0.0;
  const Vector3d delta = point - (first + parameter * edge);
  return {parameter, delta, delta.norm()};
}

/// One pair of edges where it is now.
class EdgeContact {
 public:
  EdgeContact(const EdgePair& pair, const std::vector<Vector3d>& positions,
              const SegmentDistance& nearest)
      : pair_(pair), barrier_(pair.barrier), x_(positions), nearest_(nearest) {
    for (std::uint32_t end = 0; end < 4; ++end) {
      ends_[end] = end_distance(x_[node_of(end)], x_[other_edge(end)], x_[other_edge(end) + 1]);
    }
  }

  double energy(DistanceTerms* terms) {
    double energy = find_crossing(terms != nullptr);
    for (std::uint32_t end = 0; end < 4; ++end) {
      energy += add_node(end, terms);
    }
    if (terms == nullptr) {
      return energy;
    }
    const bool is_weight_changing = crossing_ && crossing_->gradient.tail<4>() != Vector4d::Zero();
    Vector5d curvatures = Vector5d::Zero();
    curvatures.tail<4>() = curvatures_;
    if (is_weight_changing) {
      Square5d hessian = crossing_->hessian;
      hessian.diagonal() += curvatures;
      terms->couple(hessian);
      curvatures = hessian.rowwise().sum();
    } else if (crossing_) {
      curvatures[0] = crossing_->hessian(0, 0);
    }
    if (crossing_) {
      terms->push_back({nearest_.s, nearest_.t, -nearest_.delta / nearest_.distance,
                        crossing_->gradient[0], curvatures[0], crossing_->pressure});
      slopes_ += crossing_->gradient.tail<4>();
    }
    for (std::uint32_t end = 0; end < 4; ++end) {
      if (is_weight_changing || slopes_[end] != 0.0) {
        terms->push_back(term(end, ends_[end], slopes_[end], curvatures[end + 1], pressures_[end]));
      }
    }
    return energy;
  }

 private:
  /// Ends 0 and 1 are those of a, 2 and 3 those of b.
  std::uint32_t node_of(std::uint32_t end) const {
    return end < 2 ? pair_.edge_a + end : pair_.edge_b + end - 2;
  }
  std::uint32_t other_edge(std::uint32_t end) const {
    return end < 2 ? pair_.edge_b : pair_.edge_a;
  }

  static DistanceTerm term(std::uint32_t end, const EndDistance& to_end, double slope,
                           double curvature, double pressure) {
    const Vector3d normal = to_end.delta / to_end.distance;
    const double own = end % 2 == 0 ? 0.0 : 1.0;
    const double across = std::max(0.0, slope) / to_end.distance;
    return end < 2 ? DistanceTerm{own,       to_end.parameter, normal, slope,
                                  curvature, pressure,         0.0,    across}
                   : DistanceTerm{to_end.parameter, own,      -normal, slope,
                                  curvature,        pressure, 0.0,     across};
  }

  /// Finds the energy of the edges' distance, with its weight, and its derivatives if it is finite.
  double find_crossing(bool has_derivatives) {
    const double distance = nearest_.distance;
    const auto is_inner = [](double parameter) { return parameter > 0.0 && parameter < 1.0; };
    if (!is_inner(nearest_.s) || !is_inner(nearest_.t)) {
      return 0.0;
    }
    double weight = 1.0;
    std::array<Smoothstep, 4> steps{Smoothstep(1.0), Smoothstep(1.0), Smoothstep(1.0),
                                    Smoothstep(1.0)};
    for (std::uint32_t end = 0; end < 4; ++end) {
      const double further = std::max(0.0, ends_[end].distance - distance);
      steps[end] = Smoothstep(further / barrier_.width());
      weight *= steps[end].value;
    }
    if (weight == 0.0) {
      return 0.0;
    }
    const WeightedBarrier weighted(barrier_, distance, weight);
    const double energy = weighted.energy();
    if (!has_derivatives || !(energy < std::numeric_limits<double>::infinity())) {
      return energy;
    }
    const Vector3d normal = -nearest_.delta / distance;
    std::array<double, 4> cosines{};
    for (std::uint32_t end = 0; end < 4; ++end) {
      const Vector3d end_normal = (end < 2 ? 1.0 : -1.0) / ends_[end].distance * ends_[end].delta;
      cosines[end] = end_normal.dot(normal);
    }
    crossing_ = weighted.slopes(steps, cosines);
    return energy;
  }

  /// Adds the energy of the distance of an end from the other edge.
  double add_node(std::uint32_t end, DistanceTerms* terms) {
    const EndDistance& to_end = ends_[end];
    if (!pair_.owns[end] || to_end.distance >= barrier_.outer) {
      return 0.0;
    }
    double share = 1.0;
    double shared = 0.0;  // energy
    for (std::uint32_t last = 0; last < 2; ++last) {
      const double corner_parameter = last;
      const bool is_corner = to_end.parameter == corner_parameter;
      if (!pair_.has_neighbour[end][last]) {
        continue;
      }
      const bool is_neighbour_clamped = neighbour_is_clamped(end, last);
      if (is_corner) {
        // Both edges are nearest at the node between them, or the neighbouring one is nearer.
        share = is_neighbour_clamped ? 0.5 : 0.0;
      } else if (!is_neighbour_clamped) {
        shared += add_corner(end, last, terms);
      }
    }
    if (share == 0.0) {
      return shared;
    }
    if (terms != nullptr && to_end.distance > barrier_.inner) {
      slopes_[end] += share * barrier_.slope(to_end.distance);
      pressures_[end] -= share * barrier_.slope(to_end.distance);
      curvatures_[end] += share * barrier_.curvature(to_end.distance);
    }
    return share * barrier_.energy(to_end.distance) + shared;
  }

  /// Whether the edge before or after the other one is nearest to the end at their common node. It
  /// is computed as the pair with that edge does, to the last digit, so that each contact counts
  /// once.
  bool neighbour_is_clamped(std::uint32_t end, std::uint32_t last) const {
    const std::uint32_t first = last == 0 ? other_edge(end) - 1 : other_edge(end) + 1;
    const double common = last == 0 ? 1.0 : 0.0;
    return end_distance(x_[node_of(end)], x_[first], x_[first + 1]).parameter == common;
  }

  /// In the hollow of a bend neither edge is nearest at the node between them. Each of the two
  /// pairs subtracts half of the node's energy, as the potential of a polyline requires.
  double add_corner(std::uint32_t end, std::uint32_t last, DistanceTerms* terms) {
    const Vector3d delta = x_[node_of(end)] - x_[other_edge(end) + last];
    const EndDistance corner{static_cast<double>(last), delta, delta.norm()};
    if (corner.distance >= barrier_.outer || !(corner.distance > barrier_.inner)) {
      return 0.0;
    }
    if (terms != nullptr) {
      const double away = -0.5 * barrier_.slope(corner.distance);
      terms->push_back(term(end, corner, away, 0.0, 0.0));
      pressures_[end] -= away;
    }
    return -0.5 * barrier_.energy(corner.distance);
  }

  const EdgePair& pair_;
  const Barrier& barrier_;
  const std::vector<Vector3d>& x_;
  const SegmentDistance& nearest_;
  std::array<EndDistance, 4> ends_;
  std::optional<WeightedSlopes<4>> crossing_;
  Vector4d slopes_ = Vector4d::Zero();  // of the ends
  Vector4d curvatures_ = Vector4d::Zero();
  std::array<double, 4> pressures_{};
};

}  // namespace

double edge_contact(const EdgePair& pair, const std::vector<Vector3d>& positions,
                    const SegmentDistance& nearest, DistanceTerms* terms) {
  if (nearest.distance >= pair.barrier.outer) {
    return 0.0;
  }
  return EdgeContact(pair, positions, nearest).energy(terms);
}

}  // namespace fiber

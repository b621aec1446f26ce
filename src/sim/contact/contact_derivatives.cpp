// The derivatives of contacts' energies: from their distances to the equations of a step.

#include <algorithm>
#include <optional>

#include "src/sim/contact/contact_set.hpp"

namespace fiber {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Adds one side of a term to the rod it is on.
/// @param edge  of the rod
/// @param lever from the axis to the point
void add_side(std::uint32_t edge, double parameter, const SurfaceLever& lever,
              const Vector3d& gradient, const Matrix3d& hessian, RodSystem& system) {
  const SurfaceLever::Jacobian jacobian = lever.jacobian(parameter);
  const Eigen::Matrix<double, SurfaceLever::unknowns, 1> by_all = jacobian.transpose() * gradient;
  system.add_gradient(edge, by_all.head<3>());
  system.add_angle_gradient(edge, by_all[3]);
  system.add_gradient(edge + 1, by_all.tail<3>());
  const Eigen::Matrix<double, SurfaceLever::unknowns, SurfaceLever::unknowns> block =
      jacobian.transpose() * hessian * jacobian;
  const std::size_t first = std::size_t{edge} * system.unknowns();
  for (int c = 0; c < SurfaceLever::unknowns; ++c) {
    for (int r = c; r < SurfaceLever::unknowns; ++r) {
      system.add_hessian_entry(first + r, first + c, block(r, c));
    }
  }
}

/// Adds one side of a term whose points are on the axes.
/// @param node of the rod, where the edge begins
void add_side(std::uint32_t node, double parameter, const Vector3d& gradient,
              const Matrix3d& hessian, RodSystem& system) {
  const Vector2d weights(1.0 - parameter, parameter);
  system.add_gradient(node, weights[0] * gradient);
  system.add_gradient(node + 1, weights[1] * gradient);
  system.add_hessian(node, weights[0] * weights[0] * hessian);
  system.add_hessian(node + 1, weights[1] * weights[1] * hessian);
  system.add_hessian(node + 1, node, weights[0] * weights[1] * hessian);
}

/// Calls function(term) for all of them.
template <class Function>
void for_each_term(const ContactTerms& terms, const Function& function) {
  for (const ContactDerivatives& some : terms) {
    std::for_each(some.terms.begin(), some.terms.end(), function);
  }
}

/// Calls function(coupling) for all of them.
template <class Function>
void for_each_coupling(const ContactTerms& terms, const Function& function) {
  for (const ContactDerivatives& some : terms) {
    std::for_each(some.couplings.begin(), some.couplings.end(), function);
  }
}

/// The coupling of a contact's distances, whose parts are given, by the nodes of its edges.
ContactCoupling coupling_of(const ContactPoints& points, const DistanceTerms& terms,
                            const DistanceTerms::Parts& parts) {
  ContactCoupling coupling{
      points, {Vector3d::Zero(), Vector3d::Zero()}, {Vector3d::Zero(), Vector3d::Zero()}};
  for (std::size_t i = 0; i < terms.coupled_count(); ++i) {
    const DistanceTerm& term = terms.first_coupled()[i];
    const Vector3d by_point = parts[i] * term.normal;
    coupling.of_a[0] += (1.0 - term.s) * by_point;
    coupling.of_a[1] += term.s * by_point;
    if (points.is_of_rods()) {
      coupling.of_b[0] -= (1.0 - term.t) * by_point;
      coupling.of_b[1] -= term.t * by_point;
    }
  }
  return coupling;
}

/// Adds one side of a coupling.
/// @param node of the rod, where the edge begins
void add_side(std::uint32_t node, const std::array<Vector3d, 2>& by_ends, RodSystem& system) {
  system.add_hessian(node, by_ends[0] * by_ends[0].transpose());
  system.add_hessian(node + 1, by_ends[1] * by_ends[1].transpose());
  system.add_hessian(node + 1, node, by_ends[1] * by_ends[0].transpose());
}

}  // namespace

void ContactSet::find_terms(const Rods& rods, std::size_t contact, DistanceTerms& found,
                            ContactDerivatives& derivatives) const {
  std::optional<ContactPoints> coupled;
  const auto add = [&](const ContactPoints& points, const DistanceTerm& term) {
    const double curvature = found.is_coupled(term) ? -term.borrowed : term.curvature;
    if (&term == found.first_coupled()) {
      coupled = points;
    }
    derivatives.terms.push_back(
        {points, term.slope * term.normal,
         (curvature - term.across) * term.normal * term.normal.transpose() +
             term.across * Matrix3d::Identity(),
         term.turning > 0.0 ? term.turning / (term.slope * term.slope) : 0.0, nullptr});
  };
  if (contact < distance_count()) {
    for_each_term(rods, contact, found, add);
    found.for_each_coupling([&](const DistanceTerms::Parts& parts) {
      derivatives.couplings.push_back(coupling_of(*coupled, found, parts));
    });
    return;
  }
  const ResistedPoint& point = resisted_point(contact);
  const Vector3d slip = point.slip(rods);
  const double length = slip.norm();
  const Friction::Law law = point.law(length, stick_length_);
  Matrix3d hessian =
      law.resistance * (Matrix3d::Identity() - point.normal * point.normal.transpose());
  if (length > 0.0) {
    const Vector3d along = slip / length;
    hessian += (law.curvature - law.resistance) * along * along.transpose();
  }
  derivatives.terms.push_back(
      {point.points, law.resistance * slip, hessian, 0.0, point.levers ? &*point.levers : nullptr});
}

void add_derivatives(const ContactTerms& terms, const Rods& rods,
                     const std::vector<RodSystem*>& systems,
                     const std::vector<std::uint32_t>& packs, std::uint32_t which) {
  for_each_term(terms, [&](const ContactTerm& term) {
    const ContactPoints& points = term.points;
    if (packs[points.rod_a] == which) {
      const std::uint32_t edge = points.edge_a - rods.first(points.rod_a);
      RodSystem& system = *systems[points.rod_a];
      if (term.levers == nullptr) {
        add_side(edge, points.s, term.gradient, term.hessian, system);
      } else {
        add_side(edge, points.s, term.levers->front(), term.gradient, term.hessian, system);
      }
      if (term.turning > 0.0) {
        system.add_edge(edge, Vector3d::Zero(),
                        term.turning * term.gradient * term.gradient.transpose());
      }
    }
    if (points.is_of_rods() && packs[points.rod_b] == which) {
      const std::uint32_t edge = points.edge_b - rods.first(points.rod_b);
      RodSystem& system = *systems[points.rod_b];
      if (term.levers == nullptr) {
        add_side(edge, points.t, -term.gradient, term.hessian, system);
      } else {
        add_side(edge, points.t, term.levers->back(), -term.gradient, term.hessian, system);
      }
    }
  });
  for_each_coupling(terms, [&](const ContactCoupling& coupling) {
    const ContactPoints& points = coupling.points;
    if (packs[points.rod_a] == which) {
      add_side(points.edge_a - rods.first(points.rod_a), coupling.of_a, *systems[points.rod_a]);
    }
    if (points.is_of_rods() && packs[points.rod_b] == which) {
      add_side(points.edge_b - rods.first(points.rod_b), coupling.of_b, *systems[points.rod_b]);
    }
  });
}

bool has_coupling(const ContactTerms& terms) {
  return std::any_of(terms.begin(), terms.end(), [](const auto& some) {
    return std::any_of(some.terms.begin(), some.terms.end(),
                       [](const ContactTerm& term) { return term.points.is_of_rods(); });
  });
}

void add_coupling(const ContactTerms& terms, const std::vector<std::size_t>& places,
                  const SimdBatch* displacements, SimdBatch* product) {
  using Stride = Eigen::InnerStride<lane_count>;
  const auto displacement = [&](std::uint32_t node) {
    return Eigen::Map<const Vector3d, 0, Stride>(displacements->lanes.data() + places[node]);
  };
  const auto combine = [&](std::uint32_t edge, double parameter) -> Vector3d {
    return (1.0 - parameter) * displacement(edge) + parameter * displacement(edge + 1);
  };
  using Unknowns = Eigen::Matrix<double, SurfaceLever::unknowns, 1>;
  const auto combine_at = [&](std::uint32_t edge, double parameter,
                              const SurfaceLever& lever) -> Vector3d {
    return lever.jacobian(parameter) *
           Eigen::Map<const Unknowns, 0, Stride>(displacements->lanes.data() + places[edge]);
  };
  const auto spread_at = [&](std::uint32_t edge, double parameter, const SurfaceLever& lever,
                             const Vector3d& v) {
    Eigen::Map<Unknowns, 0, Stride>(product->lanes.data() + places[edge]) -=
        lever.jacobian(parameter).transpose() * v;
  };
  const auto spread = [&](std::uint32_t edge, double parameter, const Vector3d& v) {
    Eigen::Map<Vector3d, 0, Stride>(product->lanes.data() + places[edge]) -= (1.0 - parameter) * v;
    Eigen::Map<Vector3d, 0, Stride>(product->lanes.data() + places[edge + 1]) -= parameter * v;
  };
  for_each_term(terms, [&](const ContactTerm& term) {
    const ContactPoints& points = term.points;
    if (points.is_of_rods() && term.levers != nullptr) {
      const auto& [a, b] = *term.levers;
      const Vector3d from_a = term.hessian * combine_at(points.edge_a, points.s, a);
      const Vector3d from_b = term.hessian * combine_at(points.edge_b, points.t, b);
      spread_at(points.edge_a, points.s, a, from_b);
      spread_at(points.edge_b, points.t, b, from_a);
    } else if (points.is_of_rods()) {
      const Vector3d from_a = term.hessian * combine(points.edge_a, points.s);
      const Vector3d from_b = term.hessian * combine(points.edge_b, points.t);
      spread(points.edge_a, points.s, from_b);
      spread(points.edge_b, points.t, from_a);
    }
  });
  for_each_coupling(terms, [&](const ContactCoupling& coupling) {
    const ContactPoints& points = coupling.points;
    if (!points.is_of_rods()) {
      return;
    }
    const auto along = [&](std::uint32_t edge, const std::array<Vector3d, 2>& by_ends) {
      return by_ends[0].dot(displacement(edge)) + by_ends[1].dot(displacement(edge + 1));
    };
    const auto add = [&](std::uint32_t edge, const std::array<Vector3d, 2>& by_ends, double value) {
      for (std::uint32_t end = 0; end < 2; ++end) {
        Eigen::Map<Vector3d, 0, Stride>(product->lanes.data() + places[edge + end]) +=
            value * by_ends[end];
      }
    };
    const double from_a = along(points.edge_a, coupling.of_a);
    const double from_b = along(points.edge_b, coupling.of_b);
    add(points.edge_a, coupling.of_a, from_b);
    add(points.edge_b, coupling.of_b, from_a);
  });
}

}  // namespace fiber

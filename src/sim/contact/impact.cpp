#include "src/sim/contact/impact.hpp"

#include <algorithm>
#include <cmath>

namespace fiber {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// The difference of a node value between the points of two edges, or at one against an obstacle.
Vector3d difference(const ContactPoints& points, const std::vector<Vector3d>& values) {
  const auto at = [&](std::uint32_t edge, double parameter) -> Vector3d {
    return (1.0 - parameter) * values[edge] + parameter * values[edge + 1];
  };
  Vector3d found = at(points.edge_a, points.s);
  if (points.is_of_rods()) {
    found -= at(points.edge_b, points.t);
  }
  return found;
}

}  // namespace

void Impact::begin(const Rods& rods, double step) {
  // What is left of the approach is this part of it at most.
  constexpr double ratio = 1e4;
  stiffness = ratio * rods.masses[points.edge_a] / (step * step);
  motion = step * difference(points, rods.velocities);
}

Vector3d Impact::motion_after(const std::vector<Vector3d>& displacements) const {
  return motion + difference(points, displacements);
}

ContactTerm Impact::term(const std::vector<Vector3d>& displacements, const Friction* law,
                         double stick_length) const {
  ContactTerm term{points, Vector3d::Zero(), Matrix3d::Zero(), 0.0};
  const Vector3d after = motion_after(displacements);
  if (after.dot(normal) < separation) {
    term.gradient = stiffness * (motion.dot(normal) - separation) * normal;
    term.hessian = stiffness * normal * normal.transpose();
  }
  if (law != nullptr && pressure > 0.0) {
    const double max_force = law->coefficient() * pressure;
    const Vector3d slip = after - normal * normal.dot(after);
    const double length = slip.norm();
    const Friction::Law at_slip = Friction::law(length, stick_length);
    Matrix3d hessian = at_slip.resistance * (Matrix3d::Identity() - normal * normal.transpose());
    if (length > 0.0) {
      hessian +=
          (at_slip.curvature - at_slip.resistance) / (length * length) * slip * slip.transpose();
    }
    term.gradient += max_force * (at_slip.resistance * slip - hessian * (after - motion));
    term.hessian += max_force * hessian;
  }
  return term;
}

double Impact::update_forces(const std::vector<Vector3d>& displacements, const Friction* law,
                             double stick_length) {
  const Vector3d after = motion_after(displacements);
  const double pressed = std::max(0.0, stiffness * (separation - after.dot(normal)));
  Vector3d rubbed = Vector3d::Zero();
  if (law != nullptr) {
    const Vector3d slip = after - normal * normal.dot(after);
    rubbed =
        -law->coefficient() * pressed * Friction::law(slip.norm(), stick_length).resistance * slip;
  }
  const double change = std::abs(pressed - pressure) + (rubbed - friction).norm();
  pressure = pressed;
  friction = rubbed;
  return pressed > 0.0 ? change / pressed : change > 0.0 ? 1.0 : 0.0;
}

}  // namespace fiber

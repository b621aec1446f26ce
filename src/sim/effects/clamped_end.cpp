#include "src/sim/effects/clamped_end.hpp"

#include "fiber_proximity/sim/effects/twist.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

std::uint32_t edge_at(std::uint32_t node) { return node == 0 ? 0 : node - 1; }

}  // namespace

ClampedEnd::ClampedEnd(const PackLane& rod, std::uint32_t node, const Placement& placement)
    : placement_(placement),
      edge_(edge_at(node)),
      direction_(rod.direction(edge_)),
      has_twist_(rod.has_twist()) {
  set_stiffnesses(rod.bending_stiffness(), rod.twisting_stiffness(), rod.rest_length(edge_));
  if (has_twist_) {
    angle_ = rod.angle(edge_);
    director_ = rod.director(edge_);
    start_tangent_ = rod.start_tangent(edge_);
  }
}

ClampedEnd::ClampedEnd(const Rods& rods, const Attachment::Hold& hold, const Placement& placement)
    : placement_(placement),
      edge_(edge_at(hold.node)),
      direction_(edge_direction(rods, rods.first(hold.rod) + edge_)),
      has_twist_(!rods.directors.empty()) {
  const std::uint32_t edge = rods.first(hold.rod) + edge_;
  const RodSection& section = rods.sections[hold.rod];
  set_stiffnesses(section.bending_stiffness, section.twisting_stiffness, rods.rest_lengths[edge]);
  if (has_twist_) {
    angle_ = rods.angles[edge];
    director_ = current_director(rods, edge);
    start_tangent_ = rods.start_tangents[edge];
  }
}

/// Over half an edge's length of rod.
void ClampedEnd::set_stiffnesses(double bending, double twisting, double rest_length) {
  bending_ = bending / (0.5 * rest_length);
  twisting_ = twisting / (0.5 * rest_length);
}

double ClampedEnd::twist(double near) const {
  const Vector3d carried = transport(placement_.director, placement_.tangent, direction_.tangent);
  return nearest_turn(angle_ + signed_angle(carried, director_, direction_.tangent), near);
}

double ClampedEnd::energy(double near, bool has_bend) const {
  const double bend_energy = has_bend ? 0.5 * bending_ * bend().squaredNorm() : 0.0;
  if (!has_twist_) {
    return bend_energy;
  }
  const double turned = twist(near);
  return bend_energy + 0.5 * twisting_ * turned * turned;
}

void ClampedEnd::add_derivatives(double near, bool has_bend, RodSystem& system) const {
  if (has_bend) {
    add_bending(system);
  }
  if (has_twist_) {
    add_twisting(twist(near), system);
  }
}

Vector3d ClampedEnd::moment(double near, bool has_bend) const {
  Vector3d moment = Vector3d::Zero();
  if (has_bend) {
    moment += bending_ * direction_.tangent.cross(placement_.tangent);
  }
  if (has_twist_) {
    moment -= twisting_ * twist(near) * direction_.tangent;
  }
  return moment;
}

void ClampedEnd::add_bending(RodSystem& system) const {
  const Vector3d& tangent = direction_.tangent;
  const Eigen::Matrix3d across =
      (Eigen::Matrix3d::Identity() - tangent * tangent.transpose()) / direction_.length;
  const Vector3d gradient = bending_ * (across * bend());
  const Eigen::Matrix3d block = bending_ / direction_.length * across;
  system.add_edge(edge_, gradient, block);
}

void ClampedEnd::add_twisting(double twist, RodSystem& system) const {
  // The derivative of the twist by the edge's second node; by the first it is minus this.
  const Vector3d derivative =
      director_turn(start_tangent_, direction_) +
      curvature_binormal(placement_.tangent, direction_.tangent) / (2.0 * direction_.length);
  system.add_gradient(edge_, -twisting_ * twist * derivative);
  system.add_gradient(edge_ + 1, twisting_ * twist * derivative);
  system.add_angle_gradient(edge_, twisting_ * twist);
  Eigen::Matrix<double, 7, 1> by_all;
  by_all << -derivative, 1.0, derivative;
  const std::size_t start = std::size_t{edge_} * system.unknowns();
  for (Eigen::Index c = 0; c < by_all.size(); ++c) {
    for (Eigen::Index r = c; r < by_all.size(); ++r) {
      system.add_hessian_entry(start + r, start + c, twisting_ * by_all[r] * by_all[c]);
    }
  }
}

}  // namespace fiber

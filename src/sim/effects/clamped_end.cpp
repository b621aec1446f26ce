#include "clamped_end.hpp"

#include "fiber_proximity/sim/effects/twist.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

Vector3d vector_of(const std::vector<Lanes>& vectors, std::uint32_t edge, std::size_t lane) {
  const Lanes* const first = &vectors[std::size_t{3} * edge];
  return {first[0][lane], first[1][lane], first[2][lane]};
}

}  // namespace

ClampedEnd::ClampedEnd(const Rods& rods, const Attachment::Hold& hold, const Placement& placement)
    : ClampedEnd(hold, placement) {
  const std::uint32_t edge = rods.first(hold.rod) + edge_;
  const RodSection& section = rods.sections[hold.rod];
  direction_ = edge_direction(rods, edge);
  const double bending = rods.natural_curvature_vectors.empty() ? section.bending_stiffness : 0.0;
  set_stiffnesses(bending, section.twisting_stiffness, rods.rest_lengths[edge]);
  has_twist_ = !rods.directors.empty();
  if (has_twist_) {
    angle_ = rods.angles[edge];
    director_ = current_director(rods, edge);
    start_tangent_ = rods.start_tangents[edge];
  }
}

ClampedEnd::ClampedEnd(const RodLanes& rods, std::size_t lane, const Attachment::Hold& hold,
                       const Placement& placement)
    : ClampedEnd(hold, placement) {
  direction_ = {rods.lengths[edge_][lane], vector_of(rods.tangents, edge_, lane)};
  set_stiffnesses(rods.bending_stiffness[lane], rods.twisting_stiffness[lane],
                  rods.rest_lengths[edge_][lane]);
  has_twist_ = rods.unknowns == 4;
  if (has_twist_) {
    angle_ = rods.positions[std::size_t{4} * edge_ + 3][lane];
    director_ = vector_of(rods.directors, edge_, lane);
    start_tangent_ = vector_of(rods.start_tangents, edge_, lane);
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

double ClampedEnd::energy(double near) const {
  const double bend_energy = 0.5 * bending_ * bend().squaredNorm();
  if (!has_twist_) {
    return bend_energy;
  }
  const double turned = twist(near);
  return bend_energy + 0.5 * twisting_ * turned * turned;
}

void ClampedEnd::add_derivatives(double near, RodSystem& system) const {
  add_bending(system);
  if (has_twist_) {
    add_twisting(twist(near), system);
  }
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

#include "src/sim/joint/weld.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/sim/effects/cross_section.hpp"

namespace fiber {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector4d;

namespace {

/// Below this, a fold has no side, as for bending inside of a rod.
constexpr double folded = 1e-3;

/// Turns a vector about a unit vector across it.
Vector3d turned_about(const Vector3d& axis, const Vector3d& v, double angle) {
  const CosineSine turn = cosine_and_sine(angle);
  return turn.cosine * v + turn.sine * axis.cross(v);
}

}  // namespace

WeldStrain::WeldStrain(const Weld& weld, const Rods& rods, const RodState& state)
    : weld_(weld),
      has_twist_(!rods.directors.empty()),
      sections_{section(rods, state, 0), section(rods, state, 1)},
      turn_(sections_[1].tangent - sections_[0].tangent) {
  if (has_twist_) {
    strain_with_twist();
  } else {
    strain_without_twist();
  }
}

WeldStrain::Section WeldStrain::section(const Rods& rods, const RodState& state,
                                        std::size_t which) const {
  const std::uint32_t edge = weld_.edges[which].edge;
  const double sign = weld_.edges[which].sign;
  const EdgeDirection direction = edge_direction(state, edge);
  const Vector3d& tangent = direction.tangent;
  Section section;
  section.tangent = sign * tangent;
  section.length = direction.length;
  if (!has_twist_) {
    const Matrix3d across =
        sign * (Matrix3d::Identity() - tangent * tangent.transpose()) / direction.length;
    section.by_unknowns << -across, across, Vector3d::Zero();
    return section;
  }
  section.first = cross_section(rods, state, edge).first;
  if (which == 1) {
    section.first = turned_about(section.tangent, section.first, -weld_.untwisted);
  }
  section.second = section.tangent.cross(section.first);
  const Matrix3d by_second =
      cross_matrix(tangent) / direction.length +
      tangent * director_turn(rods.start_tangents[edge], direction).transpose();
  section.by_unknowns << -by_second, tangent, by_second;
  return section;
}

void WeldStrain::strain_with_twist() {
  const auto& [a, b] = sections_;
  const double angle = std::min(weld_.natural_turn.norm(), M_PI);
  const CosineSine turn = cosine_and_sine(angle);
  const Vector2d side = angle > 0.0
                            ? Vector2d(turn.sine / weld_.natural_turn.norm() * weld_.natural_turn)
                            : Vector2d::Zero();
  // The tangent that each would have, as the other section has it.
  const Vector3d natural_b = turn.cosine * a.tangent + side.x() * a.first + side.y() * a.second;
  const Vector3d natural_a = turn.cosine * b.tangent - side.x() * b.first - side.y() * b.second;
  constexpr double min_cosine = 1e-6;
  weight_ = 0.5 / std::max(min_cosine, cosine_and_sine(0.5 * angle).cosine);
  residual_ = weight_ * (b.tangent - natural_b + natural_a - a.tangent);
  levers_ = {weight_ * (a.tangent + natural_b), weight_ * (b.tangent + natural_a)};
  // The components of the turn along the mean of the material directions, as in Damping.
  const Vector3d sum = a.tangent + b.tangent;
  const double by_length = 1.0 / (sum.squaredNorm() + fold_width * fold_width);
  const double inverse = std::sqrt((1.0 + 0.25 * fold_width * fold_width) * by_length);
  const std::array<std::array<const Vector3d*, 2>, 2> directions{
      {{&a.first, &b.first}, {&a.second, &b.second}}};
  for (Eigen::Index j = 0; j < 2; ++j) {
    const auto& [of_a, of_b] = directions[static_cast<std::size_t>(j)];
    strain_[j] = inverse * (b.tangent.dot(*of_a) - a.tangent.dot(*of_b));
    by_rotation_[static_cast<std::size_t>(j)] =
        inverse * (b.tangent.cross(*of_a) + a.tangent.cross(*of_b)) +
        strain_[j] * by_length * a.tangent.cross(b.tangent);
  }
  const Vector3d carried = transport(a.first, a.tangent, b.tangent);
  strain_[2] = nearest_turn(signed_angle(carried, b.first, b.tangent), weld_.twist);
  by_rotation_[2] = sum / std::max(folded, 1.0 + a.tangent.dot(b.tangent));
  if (weld_.stiff_side.stiffness > 0.0) {
    strain_to_stiff_side(turn.cosine);
  }
}

/// The part of the residual along the mean of the directions in which both sections have the stiff
/// side, which is of unit length at rest. Where the weld is straight by nature, that is StiffBend's
/// strain.
/// @param cosine of the natural turn
void WeldStrain::strain_to_stiff_side(double cosine) {
  const Vector2d& side = weld_.stiff_side.side;
  const auto direction = [&](const Section& section) -> Vector3d {
    return side.x() * section.first + side.y() * section.second;
  };
  const Vector2d& natural = weld_.natural_turn;
  const double turning = natural.norm() > 0.0 ? natural.normalized().dot(side) : 0.0;
  const double of_both = 1.0 - (1.0 - cosine) * turning * turning;  // product of both at rest
  const double inverse = 1.0 / std::max(folded, std::sqrt(2.0 + 2.0 * of_both));
  const Vector3d of_b = direction(sections_[1]);
  const Vector3d mean = inverse * (direction(sections_[0]) + of_b);
  strain_[3] = residual_.dot(mean);
  by_rotation_[3] = levers_[1].cross(mean) + inverse * of_b.cross(residual_);
}

void WeldStrain::strain_without_twist() {
  const double size = turn_.norm();
  natural_size_ = 2.0 * std::sin(0.5 * std::min(weld_.natural_turn.norm(), M_PI));
  strain_ = {size, 0.0, 0.0, 0.0};
  direction_ = size > 0.0 ? Vector3d(turn_ / size) : sections_[0].tangent.unitOrthogonal();
}

double WeldStrain::stored_energy() const {
  if (!has_twist_) {
    const double excess = strain_[0] - natural_size_;
    return 0.5 * weld_.bending * excess * excess;
  }
  return 0.5 * weld_.bending * residual_.squaredNorm() +
         0.5 * weld_.twisting * strain_[2] * strain_[2] +
         0.5 * weld_.stiff_side.stiffness * strain_[3] * strain_[3];
}

double WeldStrain::damping_energy() const {
  const Vector4d change = strain_ - weld_.earlier_strain;
  if (!has_twist_) {
    return 0.5 * weld_.damping_share * weld_.bending * change[0] * change[0];
  }
  return 0.5 * weld_.damping_share *
         (weld_.bending * change.head<2>().squaredNorm() + weld_.twisting * change[2] * change[2] +
          weld_.stiff_side.stiffness * change[3] * change[3]);
}

/// The derivative of the energy by the rotation of each section; without twist by the tangents.
std::array<Vector3d, 2> WeldStrain::slopes() const {
  const double damped = weld_.damping_share;
  const Vector4d change = strain_ - weld_.earlier_strain;
  if (!has_twist_) {
    const double moved = strain_[0] > 0.0 ? change[0] : 0.0;
    const Vector3d slope =
        weld_.bending * (strain_[0] - natural_size_ + damped * moved) * direction_;
    return {-slope, slope};
  }
  const Vector3d between =
      damped * weld_.bending * (change[0] * by_rotation_[0] + change[1] * by_rotation_[1]) +
      twisting_moment() * by_rotation_[2] +
      weld_.stiff_side.stiffness * (strain_[3] + damped * change[3]) * by_rotation_[3];
  return {-weld_.bending * levers_[0].cross(residual_) - between,
          weld_.bending * levers_[1].cross(residual_) + between};
}

WeldStrain::Derivatives WeldStrain::derivatives() const {
  Derivatives found;
  const std::array<Vector3d, 2> by_section = slopes();
  for (std::size_t i = 0; i < 2; ++i) {
    found.gradient[i] = by_section[i].transpose() * sections_[i].by_unknowns;
    found.rows[i].setZero();
  }
  const double damped = weld_.damping_share;
  if (has_twist_) {
    const double bending = std::sqrt((1.0 + damped) * weld_.bending);
    const double twisting = std::sqrt((1.0 + damped) * weld_.twisting);
    const double to_stiff_side = std::sqrt((1.0 + damped) * weld_.stiff_side.stiffness);
    for (std::size_t i = 0; i < 2; ++i) {
      const double sign = i == 0 ? 1.0 : -1.0;
      found.rows[i].topRows<3>() =
          sign * bending * cross_matrix(levers_[i]) * sections_[i].by_unknowns;
      found.rows[i].row(3) =
          -sign * twisting * by_rotation_[2].transpose() * sections_[i].by_unknowns;
      found.rows[i].row(4) =
          -sign * to_stiff_side * by_rotation_[3].transpose() * sections_[i].by_unknowns;
    }
    return found;
  }
  // Where the rod is straighter than it wants to be it gives way sideways: that is left out.
  const double size = std::max(strain_[0], std::numeric_limits<double>::min());
  const double share_of_bend = natural_size_ > 0.0 ? 1.0 - natural_size_ / size : 1.0;
  const double share_of_damping =
      weld_.earlier_strain[0] > 0.0 ? 1.0 - weld_.earlier_strain[0] / size : 1.0;
  const double along = std::sqrt((1.0 + damped) * weld_.bending);
  const double across =
      std::sqrt(std::max(0.0, share_of_bend + damped * share_of_damping) * weld_.bending);
  const Matrix3d root =
      across * Matrix3d::Identity() + (along - across) * direction_ * direction_.transpose();
  found.rows[0].topRows<3>() = -root * sections_[0].by_unknowns;
  found.rows[1].topRows<3>() = root * sections_[1].by_unknowns;
  return found;
}

Vector3d WeldStrain::moment() const {
  const Vector3d slope = slopes()[0];
  return has_twist_ ? Vector3d(-slope) : Vector3d(-sections_[0].tangent.cross(slope));
}

double WeldStrain::twisting_moment() const {
  return has_twist_ ? weld_.twisting * (strain_[2] + weld_.damping_share *
                                                         (strain_[2] - weld_.earlier_strain[2]))
                    : 0.0;
}

Vector3d WeldStrain::bending_moment() const {
  return has_twist_ ? Vector3d(moment() - twisting_moment() * by_rotation_[2]) : moment();
}

}  // namespace fiber

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "fiber_proximity/sim/attachment.hpp"
#include "src/sim/effects/natural_bend.hpp"
#include "src/sim/effects/stiff_bend.hpp"

namespace fiber {

/// With twist: from a clamp to the cross-section of the edge that it holds [rad], by whole turns
/// near another.
inline double twist_of(const Placement& clamp, const Eigen::Vector3d& tangent,
                       const Eigen::Vector3d& director, double angle, double near) {
  const Eigen::Vector3d carried = transport(clamp.director, clamp.tangent, tangent);
  return nearest_turn(angle + signed_angle(carried, director, tangent), near);
}

inline std::uint32_t clamped_edge(std::uint32_t node) { return node == 0 ? 0 : node - 1; }

/// How a rod is at the end that a clamp holds.
struct EndBend {
  std::optional<Eigen::Vector2d>
      natural;  ///< curvature with a direction [1/m]; none: it is straight
  StiffSide stiff_side;
};

/// The end of a rod that a clamp holds: how the edge there is bent against the clamp, and with
/// twist how its cross-section is turned, over half an edge's length of rod.
class ClampedEnd {
 public:
  /// @param placement must outlive this
  /// @param near      by whole turns near which the twist is [rad]
  ClampedEnd(const PackLane& rod, std::uint32_t node, const Placement& placement, double near,
             const EndBend& end)
      : placement_(placement),
        rod_(rod),
        node_(node),
        edge_(clamped_edge(node)),
        direction_(rod.direction(edge_)),
        bending_(rod.bending_stiffness(node) / (0.5 * rod.rest_length(edge_))),
        twisting_(rod.has_twist() ? rod.twisting_stiffness(node) / (0.5 * rod.rest_length(edge_))
                                  : 0.0) {
    if (rod.has_twist()) {
      twist_ = twist_of(placement, direction_.tangent, rod.director(edge_), rod.angle(edge_), near);
    }
    const auto clamp = [&] { return CrossSection(placement.tangent, placement.director, 0.0); };
    if (end.natural) {
      bend_.emplace(NaturalBend::at_clamp(rod, node, *end.natural, clamp()));
    }
    if (end.stiff_side.stiffness > 0.0) {
      const double rest =
          end.natural ? StiffBend::rest(end.stiff_side, *end.natural, 0.5 * rod.rest_length(edge_))
                      : 0.0;
      stiff_bend_.emplace(StiffBend::at_clamp(rod, node, end.stiff_side, rest, clamp()));
    }
  }

  /// [J]
  void add_energy(double& energy) const {
    const double bending = bend_ ? 0.0 : 0.5 * bending_ * bend().squaredNorm();
    energy += rod_.has_twist() ? bending + 0.5 * twisting_ * twist_ * twist_ : bending;
    if (bend_) {
      energy += bend_->energy();
    }
    if (stiff_bend_) {
      energy += stiff_bend_->energy();
    }
  }

  void add_derivatives(RodSystem& system) const {
    if (!bend_) {
      add_bending(system);
    }
    if (rod_.has_twist()) {
      add_twisting(system);
    }
    if (bend_) {
      bend_->add_derivatives(system);
    }
    if (stiff_bend_) {
      stiff_bend_->add_derivatives(system);
    }
  }

  /// With which the clamp turns the end of the rod [N m].
  Eigen::Vector3d moment() const {
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();
    if (!bend_) {
      moment += bending_ * direction_.tangent.cross(placement_.tangent);
    }
    if (rod_.has_twist()) {
      // The twist changes with the clamp's own turn and with what carries it to the edge: the work
      // of both is that of a moment halfway between the tangents.
      const Eigen::Vector3d& tangent = placement_.tangent;
      moment -= twisting_ * twist_ / (1.0 + tangent.dot(direction_.tangent)) *
                (tangent + direction_.tangent);
    }
    if (bend_) {
      moment += node_ == 0 ? Eigen::Vector3d(-bend_->moment()) : bend_->moment();
    }
    if (stiff_bend_) {
      moment += node_ == 0 ? Eigen::Vector3d(-stiff_bend_->moment()) : stiff_bend_->moment();
    }
    return moment;
  }

 private:
  Eigen::Vector3d bend() const { return direction_.tangent - placement_.tangent; }

  void add_bending(RodSystem& system) const {
    const Eigen::Vector3d& tangent = direction_.tangent;
    const Eigen::Matrix3d across =
        (Eigen::Matrix3d::Identity() - tangent * tangent.transpose()) / direction_.length;
    const Eigen::Vector3d gradient = bending_ * (across * bend());
    const Eigen::Matrix3d block = bending_ / direction_.length * across;
    system.add_edge(edge_, gradient, block);
  }

  void add_twisting(RodSystem& system) const {
    // The derivative of the twist by the edge's second node; by the first it is minus this.
    const Eigen::Vector3d derivative =
        director_turn(rod_.start_tangent(edge_), direction_) +
        curvature_binormal(placement_.tangent, direction_.tangent) / (2.0 * direction_.length);
    system.add_gradient(edge_, -twisting_ * twist_ * derivative);
    system.add_gradient(edge_ + 1, twisting_ * twist_ * derivative);
    system.add_angle_gradient(edge_, twisting_ * twist_);
    Eigen::Matrix<double, 7, 1> by_all;
    by_all << -derivative, 1.0, derivative;
    const std::size_t start = std::size_t{edge_} * system.unknowns();
    for (Eigen::Index c = 0; c < by_all.size(); ++c) {
      for (Eigen::Index r = c; r < by_all.size(); ++r) {
        system.add_hessian_entry(start + r, start + c, twisting_ * by_all[r] * by_all[c]);
      }
    }
  }

  const Placement& placement_;
  PackLane rod_;
  std::uint32_t node_;
  std::uint32_t edge_;  // from the rod's first one
  EdgeDirection direction_;
  double bending_;      // stiffness [J]
  double twisting_;     // stiffness [J]
  double twist_ = 0.0;  // [rad]
  std::optional<NaturalBend> bend_;
  std::optional<StiffBend> stiff_bend_;
};

}  // namespace fiber

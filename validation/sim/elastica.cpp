#include "validation/sim/elastica.hpp"

#include <Eigen/Dense>
#include <array>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <cmath>

#include "validation/sim/root.hpp"

namespace fiber {
namespace {

constexpr int shooting_steps = 1000;

/// Integrates along a rod from one end, s = from, to the other.
/// @param derivative called with the state, its derivative by s, and s
template <class State, class Derivative>
State shoot(State state, const Derivative& derivative, double from) {
  boost::numeric::odeint::runge_kutta4<State> method;
  const double step = (1.0 - 2.0 * from) / shooting_steps;
  for (int i = 0; i < shooting_steps; ++i) {
    method.do_step(derivative, state, from + i * step, step);
  }
  return state;
}

/// The elastica θ'' = -(load + spread (1 - s)) cos θ from the clamp, θ(0) = 0.
/// @param curvature θ'(0)
/// @returns (θ, θ', ∫ sin θ, ∫ cos θ) at the tip
std::array<double, 4> shoot_cantilever(double load, double spread, double curvature) {
  using State = std::array<double, 4>;
  const auto derivative = [&](const State& x, State& by_s, double s) {
    const double force = load + spread * (1.0 - s);
    by_s = {x[1], -force * std::cos(x[0]), std::sin(x[0]), std::cos(x[0])};
  };
  return shoot(State{0.0, curvature, 0.0, 0.0}, derivative, 0.0);
}

/// A rod that is bent by nature and hangs down, in its plane and beside it: its angle from straight
/// down θ and θ'; and for two ways in which its tip may turn, how far each section turns about its
/// tangent (α) and about the normal in the plane (β), and what the moment on it has more about
/// these (A, B).
using HangingState = std::array<double, 10>;

struct HangingRod {
  double weight;
  double twisting_stiffness;
  double natural_curvature;

  void operator()(const HangingState& x, HangingState& by_s, double s) const {
    const double curvature = x[1];
    const double below = weight * (1.0 - s);
    const double along = below * std::cos(x[0]);
    const double across = -below * std::sin(x[0]);
    const double moment = curvature - natural_curvature;
    by_s[0] = curvature;
    by_s[1] = -across;
    for (const std::size_t i : {2, 6}) {
      const double about_tangent = x[i];
      const double about_normal = x[i + 1];
      by_s[i] = (x[i + 2] - moment * about_normal) / twisting_stiffness + curvature * about_normal;
      by_s[i + 1] = x[i + 3] + moment * about_tangent - curvature * about_tangent;
      by_s[i + 2] = curvature * x[i + 3] - across * about_normal;
      by_s[i + 3] = -curvature * x[i + 2] + along * about_normal;
    }
  }

  /// From the tip, where no moment is, up to the clamp.
  HangingState at_clamp(double tip_angle) const {
    return shoot(HangingState{tip_angle, natural_curvature, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0},
                 *this, 1.0);
  }

  /// Is 0 where the clamp, in which nothing turns, allows the tip to turn.
  double determinant() const {
    const double tip_angle =
        root_between([this](double angle) { return at_clamp(angle)[0]; }, 0.0, natural_curvature);
    const HangingState clamp = at_clamp(tip_angle);
    return clamp[2] * clamp[7] - clamp[3] * clamp[6];
  }
};

/// What is not as it should be at the clamp of a rod that stands on its tip: its angle from
/// straight down, and how far it is beside the tip; then how far above it.
/// @param tip (θ, force across the ground) at the tip
Eigen::Vector3d shoot_standing(double friction, double weight, const Eigen::Vector2d& tip) {
  using State = std::array<double, 4>;
  const auto derivative = [&](const State& x, State& by_s, double s) {
    const double down = weight * (1.0 - s) - tip[1];
    const double along_ground = friction * tip[1];
    by_s = {x[1], down * std::sin(x[0]) - along_ground * std::cos(x[0]), std::sin(x[0]),
            std::cos(x[0])};
  };
  const State clamp = shoot(State{tip[0], 0.0, 0.0, 0.0}, derivative, 1.0);
  return {clamp[0], clamp[2], -clamp[3]};
}

}  // namespace

/// At the free end there is no moment, θ'(1) = 0; at the clamp, no more than all the load at full
/// reach.
CantileverTip cantilever_tip(double load, double spread) {
  const auto moment = [&](double curvature) {
    return shoot_cantilever(load, spread, curvature)[1];
  };
  const std::array<double, 4> tip =
      shoot_cantilever(load, spread, root_between(moment, 0.0, load + 0.5 * spread));
  return {tip[2], tip[3]};
}

double critical_natural_curvature(double weight, double twisting_stiffness) {
  const auto determinant = [&](double curvature) {
    return HangingRod{weight, twisting_stiffness, curvature}.determinant();
  };
  constexpr double increment = 0.25;
  double planar = 4.0;
  while (determinant(planar + increment) > 0.0) {
    planar += increment;
  }
  return root_between(determinant, planar, planar + increment);
}

/// By Newton's method from the rod that has just buckled, by little friction, to more and more.
double lowering_until_tip_slides(double friction, double weight) {
  constexpr int increments = 20;
  constexpr int iterations = 8;
  constexpr double small = 1e-6;
  Eigen::Vector2d tip(0.0, 20.19 + weight / 3.0);
  for (int i = 1; i <= increments; ++i) {
    const double part = friction * i / increments;
    if (i == 1) {
      tip[0] = -5.6 * part;  // the linear theory of a rod without weight
    }
    for (int iteration = 0; iteration < iterations; ++iteration) {
      const Eigen::Vector3d wrong = shoot_standing(part, weight, tip);
      Eigen::Matrix2d jacobian;
      for (int axis = 0; axis < 2; ++axis) {
        const Eigen::Vector2d moved = tip + small * Eigen::Vector2d::Unit(axis);
        jacobian.col(axis) = (shoot_standing(part, weight, moved) - wrong).head<2>() / small;
      }
      tip -= jacobian.partialPivLu().solve(wrong.head<2>());
    }
  }
  return 1.0 - shoot_standing(friction, weight, tip)[2];
}

}  // namespace fiber

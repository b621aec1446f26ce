#include "validation/sim/elastica.hpp"

#include <array>
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>
#include <cmath>

#include "validation/sim/root.hpp"

namespace fiber {
namespace {

/// Shoots along the elastica θ'' = -(load + spread (1 - s)) cos θ from the clamp, θ(0) = 0.
/// @param curvature θ'(0)
/// @returns (θ, θ', ∫ sin θ, ∫ cos θ) at the tip
std::array<double, 4> shoot(double load, double spread, double curvature) {
  using State = std::array<double, 4>;
  const auto derivative = [&](const State& x, State& by_s, double s) {
    const double force = load + spread * (1.0 - s);
    by_s = {x[1], -force * std::cos(x[0]), std::sin(x[0]), std::cos(x[0])};
  };
  State x{0.0, curvature, 0.0, 0.0};
  boost::numeric::odeint::runge_kutta4<State> method;
  constexpr int steps = 1000;
  for (int i = 0; i < steps; ++i) {
    method.do_step(derivative, x, static_cast<double>(i) / steps, 1.0 / steps);
  }
  return x;
}

}  // namespace

/// At the free end there is no moment, θ'(1) = 0; at the clamp, no more than all the load at full
/// reach.
CantileverTip cantilever_tip(double load, double spread) {
  const auto moment = [&](double curvature) { return shoot(load, spread, curvature)[1]; };
  const std::array<double, 4> tip =
      shoot(load, spread, root_between(moment, 0.0, load + 0.5 * spread));
  return {tip[2], tip[3]};
}

}  // namespace fiber

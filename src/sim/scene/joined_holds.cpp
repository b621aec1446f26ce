// Whether what holds fibres that are joined leaves a place to each joint.

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/sim/scene/joints.hpp"
#include "src/sim/scene/parts.hpp"
#include "src/sim/scene/reach.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

struct Ball {
  Vector3d center;
  double radius;
};

/// Whether it is proven that some balls have no common point.
///
/// They have one where the least of max_i p_i(x), with the powers p_i(x) = |x - c_i|² - r_i², is
/// not positive. Any weights of sum 1 bound that from below by the least of the weighted sum of
/// powers, which is at the weighted mean of the centers: the Frank–Wolfe method raises this bound
/// (Frank and Wolfe 1956; with the step that is exact for this quadratic).
bool are_apart(const std::vector<Ball>& balls) {
  constexpr int max_iterations = 1000;
  constexpr double rounding = 1e-9;
  double largest = 0.0;
  for (const Ball& ball : balls) {
    largest = std::max(largest, ball.radius);
  }
  std::vector<double> weights(balls.size(), 1.0 / static_cast<double>(balls.size()));
  for (int i = 0; i < max_iterations; ++i) {
    Vector3d mean = Vector3d::Zero();
    for (std::size_t k = 0; k < balls.size(); ++k) {
      mean += weights[k] * balls[k].center;
    }
    double bound = 0.0;
    double power = -largest * largest;
    std::size_t farthest = 0;
    for (std::size_t k = 0; k < balls.size(); ++k) {
      const double own = (mean - balls[k].center).squaredNorm() - balls[k].radius * balls[k].radius;
      bound += weights[k] * own;
      if (own > power) {
        power = own;
        farthest = k;
      }
    }
    if (bound > rounding * largest * largest) {
      return true;
    }
    if (power <= 0.0) {
      return false;
    }
    const double way = (mean - balls[farthest].center).squaredNorm();
    const double share = way > 0.0 ? std::min(1.0, (power - bound) / (2.0 * way)) : 0.0;
    for (double& weight : weights) {
      weight *= 1.0 - share;
    }
    weights[farthest] += share;
  }
  return false;
}

/// The holds from which fibres lead to a joint, and how long these are [m].
struct HoldsOfJoint {
  std::vector<const SimHold*> holds;
  std::vector<double> lengths;

  /// Leaves out what the others do not need to tear it: four at most remain (Helly's theorem).
  void keep_what_tears(double time, double stretch) {
    for (std::size_t i = holds.size(); i-- > 0;) {
      HoldsOfJoint rest = *this;
      rest.holds.erase(rest.holds.begin() + static_cast<std::ptrdiff_t>(i));
      rest.lengths.erase(rest.lengths.begin() + static_cast<std::ptrdiff_t>(i));
      if (are_apart(rest.balls(time, stretch))) {
        *this = rest;
      }
    }
  }

  std::vector<Ball> balls(double time, double stretch) const {
    std::vector<Ball> balls;
    for (std::size_t i = 0; i < holds.size(); ++i) {
      balls.push_back({position_on(*holds[i], time), stretch * lengths[i]});
    }
    return balls;
  }

  /// Between waypoints holds go straight. How far the joint is from being within reach is convex
  /// in time then: it is furthest at one of these.
  std::set<double> times() const {
    std::set<double> times;
    for (const SimHold* hold : holds) {
      for (const SimWaypoint& waypoint : hold->path) {
        times.insert(waypoint.time);
      }
    }
    return times;
  }
};

std::string reaches_of(const HoldsOfJoint& torn, const SimDescription& scene, double time) {
  std::string text;
  for (std::size_t i = 0; i < torn.holds.size(); ++i) {
    const SimHold& hold = *torn.holds[i];
    const Vector3d at = position_on(hold, time);
    text += format(i == 0 ? "" : ", and ", (1.0 + scene.max_strain) * torn.lengths[i], " m from (",
                   at.x(), ", ", at.y(), ", ", at.z(), "), where node ", hold.node, " of fibre ",
                   quote(scene.fiber_names[hold.rod]), " is held");
  }
  return text;
}

}  // namespace

void require_holds_in_reach(const SimDescription& scene) {
  std::vector<HoldsOfJoint> joints(scene.joints.size());
  for (const SimHold& hold : scene.holds) {
    if (hold.frame || joints.empty()) {
      continue;
    }
    const std::vector<double> lengths = lengths_from(scene.rods, hold.rod, hold.node);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const JointNode& node = scene.joints[i].joint.nodes.front();
      const double length = lengths[scene.rods.first(node.rod) + node.node];
      if (std::isfinite(length)) {
        joints[i].holds.push_back(&hold);
        joints[i].lengths.push_back(length);
      }
    }
  }
  const double stretch = 1.0 + scene.max_strain;
  for (std::size_t i = 0; i < joints.size(); ++i) {
    for (const double time : joints[i].times()) {
      if (are_apart(joints[i].balls(time, stretch))) {
        joints[i].keep_what_tears(time, stretch);
        throw std::invalid_argument(format(scene.joints[i].place, " is torn at ", time,
                                           " s: no place is within ",
                                           reaches_of(joints[i], scene, time), ", stretched by ",
                                           100.0 * scene.max_strain, " % (max_strain)"));
      }
    }
  }
}

}  // namespace fiber

#include "src/sim/scene/lead.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "src/sim/reach.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

/// Coordinates of at most so many lengths of a fibre tell its edges' lengths to 1e-7 of the whole.
constexpr double most_lengths = 1e9;

double largest_coordinate(const SimScene& scene, std::uint32_t rod) {
  return most_lengths * rest_length(scene.stepper->rods(), rod);
}

bool is_place(const SimScene& scene, std::uint32_t rod, const Vector3d& position) {
  return position.allFinite() && position.cwiseAbs().maxCoeff() <= largest_coordinate(scene, rod);
}

std::string text_of(const Vector3d& position) {
  std::ostringstream text;
  text << "(" << position.x() << ", " << position.y() << ", " << position.z() << ")";
  return text.str();
}

std::string not_a_place(const SimScene& scene, std::uint32_t rod, const Vector3d& position) {
  std::ostringstream text;
  text.precision(3);
  text << "position is " << text_of(position) << ", coordinates of fibre "
       << quote(scene.fiber_names[rod]) << " must be finite and at most "
       << largest_coordinate(scene, rod) << " m, a billion of its lengths";
  return text.str();
}

std::vector<ReachLimit> limits_of(const SimScene& scene, const NodeOfRod& held, double time) {
  return reach_limits(scene.stepper->rods(), *scene.attachment, held.rod, held.node, time,
                      scene.max_strain);
}

std::string out_of_reach(const SimScene& scene, const NodeOfRod& held, const Vector3d& position,
                         const ReachLimit& limit) {
  std::ostringstream text;
  text.precision(3);
  text << "position " << text_of(position) << " is " << (position - limit.center).norm()
       << " m from where node " << limit.node << " of fibre " << quote(scene.fiber_names[held.rod])
       << " is held, with " << limit.rest_length << " m of it between: it reaches " << limit.radius
       << " m, stretched by " << 100.0 * scene.max_strain << " % (max_strain)";
  return text.str();
}

}  // namespace

Lead lead(const SimScene& scene, const NodeOfRod& held, const Vector3d& from,
          const Vector3d& wanted, double fastest) {
  if (!is_place(scene, held.rod, wanted)) {
    return {from, not_a_place(scene, held.rod, wanted)};
  }
  const RodSection& section = scene.stepper->rods().sections[held.rod];
  const double speed = std::min(fastest, pull_speed(section, scene.max_strain));
  const double longest = speed * scene.time_step;
  const Vector3d way = wanted - from;
  const Vector3d to = from + longest / std::max(longest, way.norm()) * way;
  const std::vector<ReachLimit> limits =
      limits_of(scene, held, scene.stepper->time() + scene.time_step);
  const double share = reachable_share(limits, from, to);
  Lead lead{from + share * (to - from), ""};
  if (share < 1.0) {
    const auto limit = std::find_if(limits.begin(), limits.end(),
                                    [&to](const auto& each) { return !each.allows(to); });
    lead.problem = out_of_reach(scene, held, wanted, *limit);
  }
  return lead;
}

void require_reach(const SimScene& scene, const NodeOfRod& held, const Vector3d& target,
                   double speed) {
  if (!is_place(scene, held.rod, target)) {
    throw std::invalid_argument(not_a_place(scene, held.rod, target));
  }
  for (const ReachLimit& limit : limits_of(scene, held, scene.stepper->time())) {
    if (!limit.allows(target)) {
      throw std::invalid_argument(out_of_reach(scene, held, target, limit));
    }
  }
  const Rods& rods = scene.stepper->rods();
  const double way = (target - rods.positions[rods.first(held.rod) + held.node]).norm();
  const double step = scene.step_length();
  const double at_most = pull_speed(rods.sections[held.rod], scene.max_strain);
  if (speed > at_most || (speed == 0.0 && way > at_most * step)) {
    std::ostringstream error;
    error.precision(3);
    error << "speed is " << speed << " m/s";
    if (speed == 0.0) {
      error << ", which is at once: " << way << " m in a step of " << step << " s are "
            << way / step << " m/s";
    }
    error << "; fibre " << quote(scene.fiber_names[held.rod]) << " may be moved at up to "
          << at_most << " m/s, which stretches it by " << 100.0 * scene.max_strain
          << " % (max_strain)";
    throw std::invalid_argument(error.str());
  }
}

}  // namespace fiber

#include "src/sim/scene/reach.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <sstream>
#include <stdexcept>

#include "src/sim/scene/parts.hpp"
#include "src/text/quote.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// The largest share of a way from inside of a sphere, or from its surface, that stays inside.
double share_inside(const Vector3d& from, const Vector3d& way, double radius) {
  // |from + s way|² = radius²: the larger solution
  const double a = way.squaredNorm();
  const double b = from.dot(way);
  const double c = from.squaredNorm() - radius * radius;
  if (!(a > 0.0)) {
    return 1.0;
  }
  const double root = std::sqrt(std::max(0.0, b * b - a * c));
  const double share = b > 0.0 ? std::max(0.0, -c) / (b + root) : (root - b) / a;
  return std::clamp(share, 0.0, 1.0);
}

}  // namespace

double rest_length_between(const Rods& rods, std::uint32_t rod, std::uint32_t node,
                           std::uint32_t other) {
  const auto edges = rods.rest_lengths.begin() + rods.first(rod);
  const auto [first, last] = std::minmax(node, other);
  return std::accumulate(edges + first, edges + last, 0.0);
}

double rest_length(const Rods& rods, std::uint32_t rod) {
  return rest_length_between(rods, rod, 0, rods.node_count(rod) - 1);
}

std::vector<double> lengths_from(const Rods& rods, std::uint32_t rod, std::uint32_t node) {
  std::vector<double> lengths(rods.positions.size(), std::numeric_limits<double>::infinity());
  std::vector<std::vector<std::uint32_t>> places;
  for (std::uint32_t i = 0; i < rods.joints.size(); ++i) {
    if (rods.joints[i] >= 0) {
      const auto joint = static_cast<std::size_t>(rods.joints[i]);
      places.resize(std::max(places.size(), joint + 1));
      places[joint].push_back(i);
    }
  }
  using Way = std::pair<double, std::uint32_t>;  // its length, and the node to which it leads
  std::priority_queue<Way, std::vector<Way>, std::greater<>> ways;
  const auto go = [&](double length, std::uint32_t to) {
    if (length < lengths[to]) {
      lengths[to] = length;
      ways.emplace(length, to);
    }
  };
  go(0.0, rods.first(rod) + node);
  while (!ways.empty()) {
    const auto [length, at] = ways.top();
    ways.pop();
    if (length > lengths[at]) {
      continue;
    }
    if (rods.rest_lengths[at] > 0.0) {  // 0 at the last node of a rod
      go(length + rods.rest_lengths[at], at + 1);
    }
    if (at > 0 && rods.rest_lengths[at - 1] > 0.0) {
      go(length + rods.rest_lengths[at - 1], at - 1);
    }
    if (!rods.joints.empty() && rods.joints[at] >= 0) {
      for (const std::uint32_t other : places[static_cast<std::size_t>(rods.joints[at])]) {
        go(length, other);
      }
    }
  }
  return lengths;
}

std::vector<ReachLimit> reach_limits(const Rods& rods, const Attachment& attachment,
                                     std::uint32_t rod, std::uint32_t node, double time,
                                     double strain) {
  std::vector<ReachLimit> limits;
  const auto add = [&](std::uint32_t other, const HeldNode& held, double length) {
    if (std::isfinite(length) && (other != rod || held.node != node)) {
      limits.push_back({other, held.node, held.position, length, (1.0 + strain) * length});
    }
  };
  if (rods.joints.empty()) {
    for (const HeldNode& held : attachment.held_at(rod, time)) {
      add(rod, held, rest_length_between(rods, rod, node, held.node));
    }
    return limits;
  }
  const std::vector<double> lengths = lengths_from(rods, rod, node);
  for (std::uint32_t other = 0; other < rods.count(); ++other) {
    for (const HeldNode& held : attachment.held_at(other, time)) {
      add(other, held, lengths[rods.first(other) + held.node]);
    }
  }
  return limits;
}

double reachable_share(const std::vector<ReachLimit>& limits, const Vector3d& from,
                       const Vector3d& to) {
  double share = 1.0;
  for (const ReachLimit& limit : limits) {
    if (!limit.allows(to)) {
      const Vector3d start = from - limit.center;
      share = std::min(share, share_inside(start, to - from, std::max(limit.radius, start.norm())));
    }
  }
  return share;
}

double pull_speed(const RodSection& section, double strain) {
  return strain * std::sqrt(section.stretching_stiffness / section.mass_per_length);
}

LargestStrain largest_strain(const Rods& rods) {
  LargestStrain largest;
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
      const double length = (rods.positions[i + 1] - rods.positions[i]).norm();
      const double strain = length / rods.rest_lengths[i] - 1.0;
      if (strain > largest.strain) {
        largest = {strain, rod, i - rods.first(rod)};
      }
    }
  }
  return largest;
}

namespace {

/// Coordinates of at most so many lengths of a fibre tell its edges' lengths to 1e-7 of the whole.
constexpr double max_lengths = 1e9;

double largest_coordinate(const SimScene& scene, std::uint32_t rod) {
  return max_lengths * rest_length(scene.stepper->rods(), rod);
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
  return format("position is ", text_of(position), ", coordinates of fibre ",
                quote(scene.fiber_names[rod]), " must be finite and at most ",
                largest_coordinate(scene, rod), " m, a billion of its lengths");
}

std::vector<ReachLimit> limits_of(const SimScene& scene, const NodeOfRod& held, double time) {
  return reach_limits(scene.stepper->rods(), *scene.attachment, held.rod, held.node, time,
                      scene.max_strain);
}

std::string out_of_reach(const SimScene& scene, const NodeOfRod& held, const Vector3d& position,
                         const ReachLimit& limit) {
  return format("position ", text_of(position), " is ", (position - limit.center).norm(),
                " m from where node ", limit.node, " of fibre ",
                quote(scene.fiber_names[limit.rod]), " is held, with ", limit.rest_length,
                limit.rod == held.rod ? " m of it" : " m", " between: it reaches ", limit.radius,
                " m, stretched by ", 100.0 * scene.max_strain, " % (max_strain)");
}

}  // namespace

std::uint32_t find_rod(const SimScene& scene, const std::string& fiber) {
  const auto& names = scene.fiber_names;
  const auto found = std::find(names.begin(), names.end(), fiber);
  if (found == names.end()) {
    throw std::invalid_argument("there is no fibre " + quote(fiber));
  }
  return static_cast<std::uint32_t>(found - names.begin());
}

NodeOfRod find_node(const SimScene& scene, std::uint32_t rod, std::int64_t index) {
  const auto count = static_cast<std::int64_t>(scene.stepper->rods().given_node_count(rod));
  const std::int64_t node = index < 0 ? count + index : index;
  if (node < 0 || node >= count) {
    throw std::invalid_argument("fibre " + quote(scene.fiber_names[rod]) + " has " +
                                std::to_string(count) + " nodes, there is no node " +
                                std::to_string(index));
  }
  if (scene.attachment == nullptr) {
    throw std::invalid_argument("the scene does not name the effect attachment");
  }
  return {rod, static_cast<std::uint32_t>(node)};
}

void remove_hold(SimScene& scene, std::uint32_t id) {
  scene.attachment->remove(id);
  scene.paths.erase(id);
}

void release_node(SimScene& scene, std::uint32_t rod, std::int64_t index) {
  const NodeOfRod held = find_node(scene, rod, index);
  const auto id = scene.attachment->find(held.rod, held.node);
  if (!id) {
    throw std::invalid_argument("nothing holds node " + std::to_string(index) + " of fibre " +
                                quote(scene.fiber_names[rod]));
  }
  remove_hold(scene, *id);
}

void hold_on_path(SimScene& scene, const NodeOfRod& node,
                  const std::shared_ptr<const PlacementPath>& path) {
  if (const auto id = scene.attachment->find(node.rod, node.node)) {
    remove_hold(scene, *id);
  }
  Attachment::Hold hold;
  hold.rod = node.rod;
  hold.node = node.node;
  hold.placement = [path](double time) { return placement_at(*path, time); };
  scene.paths.emplace(scene.attachment->add(scene.stepper->rods(), hold), path);
}

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
    const std::string at_once = speed == 0.0
                                    ? format(", which is at once: ", way, " m in a step of ", step,
                                             " s are ", way / step, " m/s")
                                    : "";
    throw std::invalid_argument(
        format("speed is ", speed, " m/s", at_once, "; fibre ", quote(scene.fiber_names[held.rod]),
               " may be moved at up to ", at_most, " m/s, which stretches it by ",
               100.0 * scene.max_strain, " % (max_strain)"));
  }
}

}  // namespace fiber

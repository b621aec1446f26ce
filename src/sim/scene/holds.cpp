#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

#include "src/geometry/smallest_rotation.hpp"
#include "src/sim/scene/keys.hpp"
#include "src/sim/scene/named_nodes.hpp"
#include "src/sim/scene/parts.hpp"
#include "src/sim/scene/times.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;
using Waypoints = std::vector<SimWaypoint>;

/// The place in the scene of each hold, by rod and node.
using HeldPlaces = std::map<std::pair<std::uint32_t, std::uint32_t>, std::string>;

/// The edge at a node that a hold there takes its direction from.
std::uint32_t edge_at(const Rods& rods, std::uint32_t rod, std::uint32_t node) {
  return std::min(rods.first(rod) + node, rods.end(rod) - 2);
}

Vector3d tangent_at(const Rods& rods, std::uint32_t edge) {
  return (rods.positions[edge + 1] - rods.positions[edge]).normalized();
}

Vector3d unit(const YamlField& field) {
  const Vector3d vector = field.vector();
  if (!vector.allFinite() || !(vector.norm() > 1e-9)) {
    field.refuse("a direction");
  }
  return vector.normalized();
}

bool is_across(const Vector3d& director, const Vector3d& tangent) {
  return (director - tangent * tangent.dot(director)).norm() > 0.5;
}

/// A director made exactly across the tangent, so that people may write round numbers.
Vector3d straightened(const Vector3d& director, const Vector3d& tangent) {
  return is_across(director, tangent) ? (director - tangent * tangent.dot(director)).normalized()
                                      : tangent.unitOrthogonal();
}

/// Changes a waypoint by the keys of an entry; without a key, the value stays.
void read_waypoint(const YamlField& entry, SimWaypoint& waypoint) {
  if (const auto position = entry.find("position")) {
    waypoint.position = position->vector();
    if (!waypoint.position.allFinite()) {
      position->refuse("finite");
    }
  }
  if (const auto tangent = entry.find("tangent")) {
    waypoint.tangent = unit(*tangent);
  }
  if (const auto director = entry.find("director")) {
    waypoint.director = unit(*director);
    if (!is_across(*waypoint.director, waypoint.tangent)) {
      director->refuse("across the tangent");
    }
  }
  if (waypoint.director) {
    waypoint.director = straightened(*waypoint.director, waypoint.tangent);
  }
}

double fastest_speed(const Waypoints& path) {
  double fastest = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    fastest = std::max(fastest, (path[i].position - path[i - 1].position).norm() /
                                    (path[i].time - path[i - 1].time));
  }
  return fastest;
}

/// A hold must begin within an edge's length of its node, or it would tear the fibre at once.
void require_near(const SimHold& hold, const Rods& rods) {
  const double length = rods.rest_lengths[edge_at(rods, hold.rod, hold.node)];
  const double away =
      (hold.path.front().position - rods.positions[rods.first(hold.rod) + hold.node]).norm();
  if (!(away <= length)) {
    throw std::invalid_argument(hold.place + " begins " + std::to_string(away) +
                                " m from where node " + std::to_string(hold.node) +
                                " is, it must begin within " + std::to_string(length) +
                                " m, an edge's length");
  }
}

SimHold read_hold(const YamlField& entry, std::uint32_t rod, const Rods& rods) {
  SimHold hold;
  hold.place = entry.place();
  hold.rod = rod;
  hold.node = read_node(entry.find("node"), rods.given_node_count(rod));
  const auto kind = entry.find("kind");
  hold.is_clamp = read_choice(kind, "pin", "clamp");
  const bool is_at_end = hold.node == 0 || hold.node + 1 == rods.given_node_count(rod);
  if (hold.is_clamp && (!is_at_end || rods.is_closed(rod))) {
    kind->refuse("pin, or node must be an end of a fibre that is not closed");
  }
  const auto path = entry.find("path");
  const auto period = entry.find("period");
  const auto frame = entry.find("frame");
  if (path && frame) {
    frame->refuse("absent where there is a path");
  }
  if (period && !path) {
    period->refuse("absent where there is no path");
  }
  if (frame) {
    hold.frame = frame->text();
  }
  if (const auto force = entry.find("max_force")) {
    hold.max_force = force->number();
    if (!(std::isfinite(hold.max_force) && hold.max_force > 0.0)) {
      force->refuse("above 0 and finite");
    }
  }
  const Vector3d beginning = rods.positions[rods.first(rod) + hold.node];
  SimWaypoint waypoint{0.0, frame ? Vector3d::Zero() : beginning,
                       tangent_at(rods, edge_at(rods, rod, hold.node)), std::nullopt};
  read_waypoint(entry, waypoint);
  hold.path = path ? read_entries(*path, "path", key_names("waypoint"), waypoint, read_waypoint)
                   : Waypoints{waypoint};
  hold.is_periodic = period.has_value();
  if (period) {
    close_entries(*period, "path", hold.path);
  }
  if (const double speed = fastest_speed(hold.path); !(speed <= max_speed)) {
    throw std::invalid_argument(hold.place + " moves with " + std::to_string(speed) +
                                " m/s, it must be at most " + std::to_string(max_speed) + " m/s");
  }
  if (!frame) {
    require_near(hold, rods);
  }
  return hold;
}

}  // namespace

Placement placement_at(const PlacementPath& path, double time) {
  const auto later = std::find_if(path.begin(), path.end(),
                                  [time](const auto& entry) { return entry.first > time; });
  if (later == path.begin() || later == path.end()) {
    return later == path.end() ? path.back().second : later->second;
  }
  const auto& [start, from] = *std::prev(later);
  const double share = (time - start) / (later->first - start);
  const Placement& to = later->second;
  Placement placement;
  placement.position = from.position + share * (to.position - from.position);
  // Opposite directions turn about any axis.
  const auto turn = smallest_rotation(from.tangent, to.tangent);
  const auto part = Eigen::Quaterniond::Identity().slerp(share, turn);
  placement.tangent = part * from.tangent;
  const Vector3d carried = turn * from.director;
  const double twist =
      std::atan2(to.tangent.dot(carried.cross(to.director)), carried.dot(to.director));
  placement.director = Eigen::AngleAxisd(share * twist, placement.tangent) * (part * from.director);
  return placement;
}

void read_holds(const YamlField& list, SimDescription& scene) {
  HeldPlaces places;
  for (const YamlField& entry : list.items()) {
    entry.require_map(key_names("attachment"));
    for (const std::uint32_t rod : find_fibers(entry.get("fiber"), scene.fibers)) {
      with_fiber_name(scene.fibers[rod].name, [&] {
        SimHold hold = read_hold(entry, rod, scene.rods);
        const auto [other, is_new] = places.insert({{rod, hold.node}, hold.place});
        if (!is_new) {
          throw std::invalid_argument(hold.place + " holds node " + std::to_string(hold.node) +
                                      ", which is held already: " + other->second);
        }
        scene.fastest_hold = std::max(scene.fastest_hold, fastest_speed(hold.path));
        scene.holds.push_back(std::move(hold));
      });
    }
  }
}

Eigen::Vector3d position_on(const SimHold& hold, double time) {
  const Waypoints& path = hold.path;
  const double at =
      hold.is_periodic && path.back().time > 0.0 ? std::fmod(time, path.back().time) : time;
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (at < path[i].time) {
      const double share = (at - path[i - 1].time) / (path[i].time - path[i - 1].time);
      return path[i - 1].position + share * (path[i].position - path[i - 1].position);
    }
  }
  return path.back().position;
}

void replace_holds(const YamlField& list, SimDescription& scene) {
  if (scene.find_effect("attachment") == nullptr) {
    throw std::invalid_argument(list.place() + ": the scene does not name the effect attachment");
  }
  const std::vector<SimHold> before = std::exchange(scene.holds, {});
  read_holds(list, scene);
  const std::vector<SimHold> replacing = scene.holds;
  std::copy_if(before.begin(), before.end(), std::back_inserter(scene.holds),
               [&](const SimHold& hold) {
                 return std::none_of(replacing.begin(), replacing.end(), [&](const SimHold& other) {
                   return other.rod == hold.rod && other.node == hold.node;
                 });
               });
}

std::function<Placement(double)> placement_of(const SimHold& hold, const SimDescription& scene,
                                              const Rods& rods,
                                              std::vector<FollowedFrame>& frames) {
  const std::uint32_t edge = edge_at(rods, hold.rod, hold.node);
  const Vector3d tangent = tangent_at(rods, edge);
  const Placement beginning{
      rods.positions[rods.first(hold.rod) + hold.node], tangent,
      rods.directors.empty() ? Vector3d(tangent.unitOrthogonal()) : rods.directors[edge]};
  const auto path = std::make_shared<PlacementPath>();
  Vector3d director = beginning.director;
  for (const SimWaypoint& waypoint : hold.path) {
    director = waypoint.director.value_or(straightened(director, waypoint.tangent));
    path->emplace_back(waypoint.time, Placement{waypoint.position, waypoint.tangent, director});
  }
  if (hold.frame) {
    frames.push_back({*hold.frame, 0, hold.rod, hold.node,
                      hold.place + ": node " + std::to_string(hold.node) + " of fibre " +
                          quote(scene.fiber_names[hold.rod]),
                      path->front().second, path});
    *path = {{0.0, beginning}};
  }
  const double period = hold.is_periodic ? hold.path.back().time : 0.0;
  return [path, period](double time) {
    return placement_at(*path, period > 0.0 ? std::fmod(time, period) : time);
  };
}

}  // namespace fiber

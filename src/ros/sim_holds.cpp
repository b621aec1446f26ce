#include "fiber_proximity/ros/sim_holds.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "fiber_proximity/geometry/smallest_rotation.hpp"
#include "fiber_proximity/ros/listed.hpp"
#include "fiber_proximity/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;
using fiber::Attachment;
using fiber::Placement;

using Path = PlacementPath;

/// Indices of the fibres of this name, or of the entry of this name.
std::vector<std::uint32_t> find_fibers(const YamlField& name, const std::vector<SimFiber>& fibers) {
  const std::string wanted = name.text();
  std::vector<std::uint32_t> found;
  std::set<std::string> names;
  for (std::uint32_t i = 0; i < fibers.size(); ++i) {
    if (fibers[i].name == wanted || fibers[i].group == wanted) {
      found.push_back(i);
    }
    names.insert(fibers[i].group);
  }
  if (found.empty()) {
    name.refuse("the name of a fibre of the scene: " + fiber::shortened(listed(names)));
  }
  return found;
}

std::uint32_t read_node(const std::optional<YamlField>& node, std::size_t count) {
  const auto last = static_cast<std::int64_t>(count) - 1;
  if (!node || node->text() == "first") {
    return 0;
  }
  return static_cast<std::uint32_t>(node->text() == "last" ? last : node->integer(0, last));
}

/// How a rod is at this node when the simulation begins.
Placement placement_of(const fiber::Rods& rods, std::uint32_t rod, std::uint32_t node) {
  const std::uint32_t i = rods.first(rod) + node;
  const std::uint32_t edge = std::min(i, rods.end(rod) - 2);
  const Vector3d tangent = (rods.positions[edge + 1] - rods.positions[edge]).normalized();
  return {rods.positions[i], tangent,
          rods.directors.empty() ? tangent.unitOrthogonal() : rods.directors[edge]};
}

Vector3d unit(const YamlField& field) {
  const Vector3d vector = field.vector();
  if (!vector.allFinite() || !(vector.norm() > 1e-9)) {
    field.refuse("a direction");
  }
  return vector.normalized();
}

/// What the entry says of a placement; the rest stays.
void read_placement(const YamlField& entry, Placement& placement) {
  if (const auto position = entry.find("position")) {
    placement.position = position->vector();
  }
  if (const auto tangent = entry.find("tangent")) {
    placement.tangent = unit(*tangent);
  }
  if (const auto director = entry.find("director")) {
    placement.director = unit(*director);
  }
  // Made exact here, so that people may write round numbers.
  const Vector3d across =
      placement.director - placement.tangent * placement.tangent.dot(placement.director);
  if (across.norm() > 0.5) {
    placement.director = across.normalized();
  } else if (const auto director = entry.find("director")) {
    director->refuse("across the tangent");
  } else {
    placement.director = placement.tangent.unitOrthogonal();
  }
}

Path read_path(const YamlField& list, Placement placement) {
  Path path;
  for (const YamlField& entry : list.items()) {
    entry.require_map({"time", "position", "tangent", "director"});
    const YamlField time = entry.get("time");
    if (!std::isfinite(time.number())) {
      time.refuse("finite");
    }
    if (!path.empty() && !(time.number() > path.back().first)) {
      time.refuse("later than the time before, " + std::to_string(path.back().first) + " s");
    }
    if (path.empty() && time.number() != 0.0) {
      time.refuse("0, where the path begins");
    }
    read_placement(entry, placement);
    path.emplace_back(time.number(), placement);
  }
  if (path.empty()) {
    list.refuse("a list of at least one entry");
  }
  return path;
}

/// Leads a path back to where it begins, after which it begins again.
/// @returns the period [s]
double close_path(const YamlField& period, Path& path) {
  const double length = period.number();
  if (!(std::isfinite(length) && length > path.back().first)) {
    period.refuse("longer than the path, " + std::to_string(path.back().first) +
                  " s: it leads back to its beginning");
  }
  path.emplace_back(length, path.front().second);
  return length;
}

double fastest_speed(const Path& path) {
  double fastest = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    fastest = std::max(fastest, (path[i].second.position - path[i - 1].second.position).norm() /
                                    (path[i].first - path[i - 1].first));
  }
  return fastest;
}

/// Before the first entry and after the last one these hold.
Placement at(const Path& path, double time) {
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
  // Directions turn at equal rates; opposite ones turn about any axis.
  const auto turn = fiber::smallest_rotation(from.tangent, to.tangent);
  const auto part = Eigen::Quaterniond::Identity().slerp(share, turn);
  placement.tangent = part * from.tangent;
  const Vector3d carried = turn * from.director;
  const double twist =
      std::atan2(to.tangent.dot(carried.cross(to.director)), carried.dot(to.director));
  placement.director = Eigen::AngleAxisd(share * twist, placement.tangent) * (part * from.director);
  return placement;
}

Attachment::Kind read_kind(const std::optional<YamlField>& kind) {
  if (!kind || kind->text() == "pin") {
    return Attachment::Kind::PIN;
  }
  if (kind->text() != "clamp") {
    kind->refuse("pin or clamp");
  }
  return Attachment::Kind::CLAMP;
}

/// Where the fibre would be torn in the first step: a hold begins where it is, within an edge.
void require_near(const YamlField& entry, const Placement& begin, const SimFiber& fiber,
                  std::uint32_t node) {
  const std::uint32_t edge = std::min(node, static_cast<std::uint32_t>(fiber.points.size()) - 2);
  const double length = (fiber.points[edge + 1] - fiber.points[edge]).norm();
  const double away = (begin.position - fiber.points[node]).norm();
  if (!(away <= length)) {
    throw std::invalid_argument(entry.place() + " begins " + std::to_string(away) +
                                " m from where node " + std::to_string(node) +
                                " is, it must begin within " + std::to_string(length) +
                                " m, an edge's length");
  }
}

std::function<Placement(double)> follow(const YamlField& entry, Path path, double& fastest) {
  const auto period = entry.find("period");
  const double length = period ? close_path(*period, path) : 0.0;
  fastest = std::max(fastest, fastest_speed(path));
  if (period) {
    return [path, length](double time) { return at(path, std::fmod(time, length)); };
  }
  return [path](double time) { return at(path, time); };
}

void read_hold(const YamlField& entry, std::uint32_t rod, const SimFiber& fiber,
               const fiber::Rods& rods, SimHolds& holds) {
  Attachment::Hold hold;
  hold.rod = rod;
  hold.node = read_node(entry.find("node"), fiber.points.size());
  hold.kind = read_kind(entry.find("kind"));
  const auto path = entry.find("path");
  const auto frame = entry.find("frame");
  Placement placement = placement_of(rods, rod, hold.node);
  const Placement beginning = placement;
  if (frame) {
    placement.position.setZero();
  }
  read_placement(entry, placement);
  if (path && frame) {
    frame->refuse("absent where there is a path");
  }
  if (!path && entry.find("period")) {
    entry.get("period").refuse("absent where there is no path");
  }
  if (path) {
    hold.placement = follow(entry, read_path(*path, placement), holds.fastest);
  } else {
    const auto shared = std::make_shared<Path>(Path{{0.0, frame ? beginning : placement}});
    hold.placement = [shared](double time) { return at(*shared, time); };
    if (frame) {
      holds.frames.push_back({frame->text(), rod, hold.node,
                              entry.place() + ": node " + std::to_string(hold.node) + " of fibre " +
                                  fiber::quote(fiber.name),
                              placement, shared});
    }
  }
  require_near(entry, hold.placement(0.0), fiber, hold.node);
  for (const SimHold& other : holds.holds) {
    if (other.hold.rod == rod && other.hold.node == hold.node) {
      throw std::invalid_argument(entry.place() + " holds node " + std::to_string(hold.node) +
                                  ", which is held already: " + other.place);
    }
  }
  holds.holds.push_back({hold, entry.place()});
}

}  // namespace

SimHolds read_sim_holds(const YamlField& list, const std::vector<SimFiber>& fibers,
                        const fiber::Rods& rods) {
  SimHolds holds;
  for (const YamlField& entry : list.items()) {
    entry.require_map(
        {"fiber", "node", "kind", "position", "tangent", "director", "path", "period", "frame"});
    for (const std::uint32_t rod : find_fibers(entry.get("fiber"), fibers)) {
      naming_fiber(fibers[rod].name, [&] { read_hold(entry, rod, fibers[rod], rods, holds); });
    }
  }
  return holds;
}

}  // namespace fiber_proximity_ros

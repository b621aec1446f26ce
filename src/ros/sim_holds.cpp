#include "fiber_proximity/ros/sim_holds.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "fiber_proximity/ros/listed.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;
using fiber::Attachment;
using fiber::Placement;

/// Placements by time [s], which rises.
using Path = std::vector<std::pair<double, Placement>>;

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
    name.refuse("the name of a fibre of the scene: " + listed(names));
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

/// How the fibre is at this node when the simulation begins.
Placement placement_of(const SimFiber& fiber, std::uint32_t node) {
  const std::uint32_t edge = std::min(node, static_cast<std::uint32_t>(fiber.points.size()) - 2);
  const Vector3d tangent = (fiber.points[edge + 1] - fiber.points[edge]).normalized();
  return {fiber.points[node], tangent, tangent.unitOrthogonal()};
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
  const auto turn = Eigen::Quaterniond::FromTwoVectors(from.tangent, to.tangent);
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

void read_hold(const YamlField& entry, std::uint32_t rod, const SimFiber& fiber, SimHolds& holds) {
  Attachment::Hold hold;
  hold.rod = rod;
  hold.node = read_node(entry.find("node"), fiber.points.size());
  hold.kind = read_kind(entry.find("kind"));
  const auto path = entry.find("path");
  const auto frame = entry.find("frame");
  Placement placement = placement_of(fiber, hold.node);
  const Placement beginning = placement;
  if (frame) {
    placement.position.setZero();
  }
  read_placement(entry, placement);
  if (path && frame) {
    frame->refuse("absent where there is a path");
  }
  if (path) {
    hold.placement = [path = read_path(*path, placement)](double time) { return at(path, time); };
  } else {
    const auto shared = std::make_shared<Placement>(frame ? beginning : placement);
    hold.placement = [shared](double) { return *shared; };
    if (frame) {
      holds.frames.push_back(
          {frame->text(), "node " + std::to_string(hold.node) + " of fibre '" + fiber.name + "'",
           placement, shared});
    }
  }
  holds.holds.push_back({hold, entry.place()});
}

}  // namespace

SimHolds read_sim_holds(const YamlField& list, const std::vector<SimFiber>& fibers) {
  SimHolds holds;
  for (const YamlField& entry : list.items()) {
    entry.require_map(
        {"fiber", "node", "kind", "position", "tangent", "director", "path", "frame"});
    for (const std::uint32_t rod : find_fibers(entry.get("fiber"), fibers)) {
      read_hold(entry, rod, fibers[rod], holds);
    }
  }
  return holds;
}

}  // namespace fiber_proximity_ros

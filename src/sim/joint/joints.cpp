#include "fiber_proximity/sim/joints.hpp"

#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "fiber_proximity/sim/effects.hpp"
#include "src/sim/edges.hpp"
#include "src/sim/joint/joint_parts.hpp"
#include "src/sim/joint/make_welds.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

[[noreturn]] void refuse_joint(std::size_t joint, const std::string& problem) {
  throw std::invalid_argument("joint " + std::to_string(joint) + ": " + problem);
}

std::string name_of(const JointNode& node) {
  return "node " + std::to_string(node.node) + " of rod " + std::to_string(node.rod);
}

/// The natural turn of a closed rod where it begins and ends, as at a node inside.
Eigen::Vector2d natural_turn_at_seam(const Rods& rods, std::uint32_t rod) {
  const std::uint32_t node = rods.first(rod);
  const double length = rods.rest_length_at_seam(rod);
  if (!rods.natural_curvature_vectors.empty()) {
    return length * rods.natural_curvature_vectors[node];
  }
  const double curvature = rods.natural_curvatures.empty() ? 0.0 : rods.natural_curvatures[node];
  return {length * curvature, 0.0};
}

/// Beyond this, gaps between nodes are no rounding errors [m].
double allowed_gap(const Rods& rods, const std::vector<PlacedNode>& place) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const WeldedEdge& edge : edges_at(rods, place)) {
    shortest = std::min(shortest, rods.rest_lengths[edge.edge]);
  }
  return Joints::max_gap * shortest;
}

/// Tells the rods which nodes are one place.
void mark_places(const JointParts& parts, Rods& rods) {
  rods.joints.assign(rods.positions.size(), -1);
  for (std::size_t i = 0; i < parts.places.size(); ++i) {
    for (const PlacedNode& each : parts.places[i]) {
      rods.joints[each.node] = static_cast<std::int32_t>(i);
    }
  }
}

/// The place that has a node, or the end.
auto place_of(JointParts& parts, std::uint32_t node) {
  return std::find_if(parts.places.begin(), parts.places.end(), [&](const auto& place) {
    return std::any_of(place.begin(), place.end(),
                       [&](const PlacedNode& each) { return each.node == node; });
  });
}

}  // namespace

Joints::Joints(Options options)
    : options_(std::move(options)), parts_(std::make_unique<JointParts>()) {}

Joints::~Joints() = default;

std::uint32_t Joints::add(Rods& rods, const Joint& joint) {
  const std::size_t index = joints_.size();
  if (joint.nodes.size() < 2) {
    refuse_joint(index, "it has " + std::to_string(joint.nodes.size()) +
                            " node(s), it must have at least 2");
  }
  if (joint.kind == Kind::WELD && !options_.has_bend) {
    refuse_joint(index, "a weld keeps angles by what resists bending, and nothing does");
  }
  std::vector<PlacedNode> place;
  std::vector<std::size_t> seams;  // places of closed rods that become a part of this
  for (const JointNode& each : joint.nodes) {
    if (each.rod >= rods.count()) {
      refuse_joint(index, name_of(each) + ": there are " + std::to_string(rods.count()) + " rods");
    }
    if (each.node >= rods.node_count(each.rod)) {
      refuse_joint(index, name_of(each) + ": the rod has " +
                              std::to_string(rods.node_count(each.rod)) + " nodes");
    }
    const std::uint32_t node = rods.first(each.rod) + each.node;
    const auto found = place_of(*parts_, node);
    const auto is_in_place = [&] {
      return std::any_of(place.begin(), place.end(),
                         [&](const PlacedNode& other) { return other.node == node; });
    };
    const bool is_seam = found != parts_->places.end() && found->size() == 2 &&
                         found->front().rod == found->back().rod && rods.is_closed(each.rod) &&
                         found->front().node == rods.first(each.rod) &&
                         found->back().node + 1 == rods.end(each.rod);
    if (is_in_place() || (found != parts_->places.end() && !is_seam)) {
      refuse_joint(index, name_of(each) + " is joined already");
    }
    if (is_seam) {
      place.insert(place.end(), found->begin(), found->end());
      seams.push_back(static_cast<std::size_t>(found - parts_->places.begin()));
    } else {
      place.push_back({each.rod, node});
    }
  }
  const double allowed = allowed_gap(rods, place);
  for (std::size_t i = 1; i < place.size(); ++i) {
    const double gap = (rods.positions[place[i].node] - rods.positions[place.front().node]).norm();
    if (!(gap <= allowed)) {
      std::ostringstream problem;
      problem << name_of({place[i].rod, place[i].node - rods.first(place[i].rod)}) << " is " << gap
              << " m from "
              << name_of({place.front().rod, place.front().node - rods.first(place.front().rod)})
              << ", they must be within " << allowed << " m";
      refuse_joint(index, problem.str());
    }
  }
  std::sort(seams.rbegin(), seams.rend());
  for (const std::size_t seam : seams) {
    parts_->places.erase(parts_->places.begin() + static_cast<std::ptrdiff_t>(seam));
    parts_->joints.erase(parts_->joints.begin() + static_cast<std::ptrdiff_t>(seam));
  }
  parts_->places.push_back(place);
  parts_->joints.push_back(static_cast<std::int32_t>(index));
  mark_places(*parts_, rods);
  unite(rods);
  if (joint.kind == Kind::WELD) {
    add_welds(rods, place, parts_->welds);
  }
  joints_.push_back(joint);
  return static_cast<std::uint32_t>(index);
}

void Joints::close(Rods& rods, std::uint32_t rod) {
  const auto refuse_rod = [&](const std::string& problem) {
    throw std::invalid_argument("closed rod " + std::to_string(rod) + ": " + problem);
  };
  if (rod >= rods.count()) {
    refuse_rod("there are " + std::to_string(rods.count()) + " rods");
  }
  constexpr std::uint32_t min_nodes = 4;  // of three edges
  const std::uint32_t count = rods.node_count(rod);
  if (count < min_nodes) {
    refuse_rod("it has " + std::to_string(count - 1) + " edge(s), it must have at least 3");
  }
  const std::uint32_t first = rods.first(rod);
  const std::uint32_t last = rods.end(rod) - 1;
  if (place_of(*parts_, first) != parts_->places.end() ||
      place_of(*parts_, last) != parts_->places.end()) {
    refuse_rod("an end of it is joined already");
  }
  const std::vector<PlacedNode> place{{rod, first}, {rod, last}};
  const double gap = (rods.positions[last] - rods.positions[first]).norm();
  if (!(gap <= allowed_gap(rods, place))) {
    std::ostringstream problem;
    problem << "its ends are " << gap << " m apart, they must be within "
            << allowed_gap(rods, place) << " m";
    refuse_rod(problem.str());
  }
  rods.closed.resize(rods.count(), 0);
  rods.closed[rod] = 1;
  parts_->places.push_back(place);
  parts_->joints.push_back(-1);
  mark_places(*parts_, rods);
  unite(rods);
  if (options_.has_bend || !rods.angles.empty()) {
    parts_->welds.push_back(make_seam(rods, rod, options_.has_bend));
  }
}

void Joints::unite(Rods& rods) const {
  for (const std::vector<PlacedNode>& place : parts_->places) {
    for (std::vector<Vector3d>* values : {&rods.positions, &rods.velocities}) {
      const auto value = [&](std::uint32_t node) -> const Vector3d& { return (*values)[node]; };
      if (std::all_of(place.begin(), place.end(), [&](const PlacedNode& each) {
            return value(each.node) == value(place.front().node);
          })) {
        continue;
      }
      const Vector3d mean = mean_at(place, rods.masses, value);
      for (const PlacedNode& each : place) {
        (*values)[each.node] = mean;
      }
    }
  }
}

void Joints::begin_step(const Rods& rods, const TimeStep& step) {
  for (Weld& weld : parts_->welds) {
    if (weld.is_seam) {
      weld.natural_turn = natural_turn_at_seam(rods, weld.edges[0].rod);
    }
    weld.damping_share =
        options_.damping == nullptr ? 0.0 : options_.damping->relaxation_time() / step.length;
    if (weld.damping_share > 0.0) {
      Eigen::Vector4d strain = Eigen::Vector4d::Zero();
      step.for_each_earlier(rods, [&](const RodState& state, double weight) {
        strain += weight * WeldStrain(weld, rods, state).strain();
      });
      // Without twist the strain is a size.
      weld.earlier_strain = rods.directors.empty() ? strain.cwiseMax(0.0) : strain;
    }
  }
}

void Joints::take_state(const Joints& other) { *parts_ = *other.parts_; }

double Joints::stored_energy(const Rods& rods) const {
  double energy = 0.0;
  for (const Weld& weld : parts_->welds) {
    energy += WeldStrain(weld, rods, rods).stored_energy();
  }
  return energy;
}

void Joints::end_step(const Rods& rods) {
  for (Weld& weld : parts_->welds) {
    if (!rods.directors.empty()) {
      weld.twist = WeldStrain(weld, rods, rods).twist();
    }
  }
}

FiberAssembly assembly_of(const Rods& rods) {
  if (rods.joints.empty()) {
    return {rods.positions, rods.offsets, rods.assembly_radii()};
  }
  std::vector<std::uint32_t> members;  // by joint: given points
  FiberTopology topology;
  const std::vector<double> all_radii = rods.assembly_radii();
  std::vector<double> radii = rods.edge_radii.empty() ? all_radii : std::vector<double>();
  topology.closed = rods.closed;
  std::vector<Vector3d> points;
  std::vector<std::uint32_t> offsets{0};
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    for (std::uint32_t i = 0; i < rods.given_node_count(rod); ++i) {
      points.push_back(rods.positions[rods.first(rod) + i]);
      if (!rods.edge_radii.empty()) {
        radii.push_back(all_radii[rods.first(rod) + i]);
      }
      const std::int32_t joint = rods.joints[rods.first(rod) + i];
      topology.joints.push_back(joint);
      if (joint >= 0) {
        members.resize(std::max(members.size(), static_cast<std::size_t>(joint) + 1), 0);
        ++members[static_cast<std::size_t>(joint)];
      }
    }
    offsets.push_back(static_cast<std::uint32_t>(points.size()));
  }
  // Where a closed rod begins and ends, and no other is, is no joint of the points given.
  for (std::int32_t& joint : topology.joints) {
    joint = joint >= 0 && members[static_cast<std::size_t>(joint)] > 1 ? joint : -1;
  }
  if (std::all_of(topology.joints.begin(), topology.joints.end(), [](auto j) { return j < 0; })) {
    topology.joints.clear();
  }
  return {points, offsets, radii, topology};
}

}  // namespace fiber

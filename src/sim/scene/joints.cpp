#include "src/sim/scene/joints.hpp"

#include <algorithm>
#include <cmath>

#include "src/sim/scene/keys.hpp"
#include "src/sim/scene/named_nodes.hpp"
#include "src/sim/scene/parts.hpp"
#include "src/text/with_context.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

JointNodeEntry read_joint_node(const YamlField& entry) {
  entry.require_map(key_names("joint node"));
  JointNodeEntry read{entry.get("fiber"), entry.find("node"), entry.find("at")};
  if (read.at && read.node) {
    read.at->refuse("absent where there is a node");
  }
  if (read.at) {
    read.share = read.at->number();
    const KeyLimits& limits = key_limits("joint node", "at");
    if (!limits.contain(read.share)) {
      read.at->refuse(limits.text());
    }
  }
  return read;
}

JointEntry read_joint(const YamlField& entry) {
  entry.require_map(key_names("joint"));
  JointEntry joint;
  joint.place = entry.place();
  if (read_choice(entry.find("kind"), "ball", "weld")) {
    joint.kind = Joints::Kind::WELD;
  }
  const YamlField nodes = entry.get("nodes");
  for (const YamlField& node : nodes.items()) {
    joint.nodes.push_back(read_joint_node(node));
  }
  if (joint.nodes.size() < 2) {
    nodes.refuse("a list of at least two nodes");
  }
  return joint;
}

/// Whether a name is that of an entry, or of one of its fibres if it is repeated.
bool is_of_entry(const std::string& name, const FiberEntry& entry) {
  const std::string& own = entry.name;
  const std::string number = name.size() > own.size() + 1 ? name.substr(own.size() + 1) : "";
  return name == own ||
         (entry.count && name.rfind(own + "_", 0) == 0 && !number.empty() &&
          std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; }));
}

std::uint32_t node_of(const JointNodeEntry& entry, const SimDescription& scene, std::uint32_t rod) {
  if (entry.at) {
    return scene.fibers[rod].nodes_at.at(entry.share);
  }
  return read_node(entry.node, scene.rods.given_node_count(rod));
}

std::string name_of(const SimDescription& scene, const JointNode& node) {
  return format("node ", node.node, " of fibre ", quote(scene.fiber_names[node.rod]));
}

/// The fibres that an entry's nodes name: as many joints, of one fibre of each.
std::vector<std::vector<std::uint32_t>> fibers_of(const JointEntry& entry,
                                                  const SimDescription& scene) {
  std::vector<std::vector<std::uint32_t>> by_node;
  for (const JointNodeEntry& node : entry.nodes) {
    by_node.push_back(find_fibers(node.fiber, scene.fibers));
    if (by_node.back().size() != by_node.front().size()) {
      node.fiber.refuse(format("the name of ", by_node.front().size(),
                               " fibre(s), as the first node names: the n-th of each are joined"));
    }
  }
  return by_node;
}

/// Whether two nodes are ends of one edge, which would have no length if they were one place.
bool are_ends_of_an_edge(const Rods& rods, const JointNode& a, const JointNode& b) {
  const auto [least, most] = std::minmax(a.node, b.node);
  return a.rod == b.rod && (most == least + 1 || (rods.is_closed(a.rod) && least == 0 &&
                                                  most + 1 == rods.given_node_count(a.rod)));
}

void require_new(const std::string& place, const SimDescription& scene,
                 const Joints::Joint& joint) {
  const auto is_same = [](const JointNode& a, const JointNode& b) {
    return a.rod == b.rod && a.node == b.node;
  };
  for (std::size_t i = 0; i < joint.nodes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (is_same(joint.nodes[i], joint.nodes[j])) {
        throw std::invalid_argument(place + ": " + name_of(scene, joint.nodes[i]) +
                                    " is there twice");
      }
      if (are_ends_of_an_edge(scene.rods, joint.nodes[i], joint.nodes[j])) {
        throw std::invalid_argument(place + ": " + name_of(scene, joint.nodes[j]) + " and " +
                                    name_of(scene, joint.nodes[i]) +
                                    " are ends of one segment, which would have no length");
      }
    }
    for (const SimJoint& other : scene.joints) {
      for (const JointNode& node : other.joint.nodes) {
        if (is_same(node, joint.nodes[i])) {
          throw std::invalid_argument(place + ": " + name_of(scene, node) +
                                      " is joined already: " + other.place);
        }
      }
    }
  }
}

/// Makes a rod with sections one that is at rest where it is: what its edges are longer or shorter
/// by is of its own section.
void rest_again_in_sections(Rods& rods, std::uint32_t rod) {
  SectionLengths& lengths = rods.section_lengths;
  for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
    const double before = rods.rest_lengths[i];
    rods.rest_lengths[i] = (rods.positions[i + 1] - rods.positions[i]).norm();
    const double half = 0.5 * (rods.rest_lengths[i] - before);
    const double ratio = rods.rest_lengths[i] / before;
    lengths.stretching[i] *= ratio;
    lengths.inertias[i] *= ratio;
    for (const std::uint32_t node : {i, i + 1}) {
      rods.masses[node] += half * rods.sections[rod].mass_per_length;
      if (!rods.is_rigid(i)) {
        lengths.bending[node] += half;
        lengths.stiff[node] += half / rods.sections[rod].bending_ratio;
        lengths.twisting[node] += half;
      }
    }
  }
}

/// Makes a rod of a scene one that is at rest where it is.
void rest_again(Rods& rods, std::uint32_t rod) {
  if (!rods.section_lengths.empty()) {
    rest_again_in_sections(rods, rod);
    return;
  }
  for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
    rods.masses[i] = 0.0;
  }
  for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
    rods.rest_lengths[i] = (rods.positions[i + 1] - rods.positions[i]).norm();
    const double half_mass = 0.5 * rods.sections[rod].mass_per_length * rods.rest_lengths[i];
    rods.masses[i] += half_mass;
    rods.masses[i + 1] += half_mass;
  }
}

/// Moves the nodes of a joint to the first of them, if they are as near as that.
void meet(const std::string& place, const Joints::Joint& joint, SimDescription& scene) {
  Rods& rods = scene.rods;
  double allowed = 0.0;
  for (const JointNode& node : joint.nodes) {
    allowed = std::max(allowed, rods.node_radius(node.rod, rods.first(node.rod) + node.node));
  }
  const JointNode& first = joint.nodes.front();
  const Vector3d at = rods.positions[rods.first(first.rod) + first.node];
  for (const JointNode& node : joint.nodes) {
    Vector3d& position = rods.positions[rods.first(node.rod) + node.node];
    const double gap = (position - at).norm();
    if (!(gap <= allowed)) {
      throw std::invalid_argument(format(place, ": ", name_of(scene, node), " begins ", gap,
                                         " m from ", name_of(scene, first),
                                         ", to which it is joined; it must begin within ", allowed,
                                         " m, the largest radius there"));
    }
    if (gap > 0.0) {
      position = at;
      if (rods.is_closed(node.rod) && node.node == 0) {
        rods.positions[rods.end(node.rod) - 1] = at;
      }
      rest_again(rods, node.rod);
    }
  }
}

}  // namespace

std::vector<JointEntry> read_joints(const YamlField& list) {
  std::vector<JointEntry> joints;
  for (const YamlField& entry : list.items()) {
    joints.push_back(read_joint(entry));
  }
  if (joints.empty()) {
    list.refuse("a list of at least one joint");
  }
  return joints;
}

std::vector<double> joint_shares(const std::vector<JointEntry>& joints, const FiberEntry& entry) {
  std::vector<double> shares;
  for (const JointEntry& joint : joints) {
    for (const JointNodeEntry& node : joint.nodes) {
      if (node.at && is_of_entry(node.fiber.text(), entry)) {
        shares.push_back(node.share);
      }
    }
  }
  std::sort(shares.begin(), shares.end());
  shares.erase(std::unique(shares.begin(), shares.end()), shares.end());
  return shares;
}

void find_joints(const std::vector<JointEntry>& entries, SimDescription& scene) {
  for (const JointEntry& entry : entries) {
    if (entry.kind == Joints::Kind::WELD && !scene.has_effect("bend")) {
      throw std::invalid_argument(entry.place +
                                  ": a weld keeps angles by what resists bending, name the effect "
                                  "bend, too");
    }
    const auto fibers = fibers_of(entry, scene);
    for (std::size_t i = 0; i < fibers.front().size(); ++i) {
      Joints::Joint joint{entry.kind, {}};
      for (std::size_t node = 0; node < entry.nodes.size(); ++node) {
        const std::uint32_t rod = fibers[node][i];
        with_fiber_name(scene.fiber_names[rod], [&] {
          joint.nodes.push_back({rod, node_of(entry.nodes[node], scene, rod)});
        });
      }
      require_new(entry.place, scene, joint);
      meet(entry.place, joint, scene);
      scene.joints.push_back({entry.place, std::move(joint)});
    }
  }
  // The rods of the description know what is joined.
  make_joints(scene, scene.rods, nullptr);
}

std::unique_ptr<Joints> make_joints(const SimDescription& scene, Rods& rods,
                                    const std::shared_ptr<const Damping>& damping) {
  if (scene.joints.empty() && rods.closed.empty()) {
    return nullptr;
  }
  auto joints = std::make_unique<Joints>(Joints::Options{scene.has_effect("bend"), damping});
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    if (rods.is_closed(rod)) {
      with_context(scene.fibers[rod].place, [&] { joints->close(rods, rod); });
    }
  }
  for (const SimJoint& each : scene.joints) {
    with_context(each.place, [&] { joints->add(rods, each.joint); });
  }
  return joints;
}

}  // namespace fiber

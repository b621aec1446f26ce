// Joints of a scene's fibres: read before fibres are cut into segments, made when they are.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/sim/joints.hpp"
#include "fiber_proximity/sim/scene/scene.hpp"
#include "src/sim/scene/fibers.hpp"

namespace fiber {

/// A node that a joint names: by its index, or by its share of the fibre's length.
struct JointNodeEntry {
  YamlField fiber;
  std::optional<YamlField> node;
  std::optional<YamlField> at;
  double share = 0.0;  ///< in [0, 1], where there is `at`
};

/// An entry of the effect `joint`.
struct JointEntry {
  std::string place;
  Joints::Kind kind = Joints::Kind::BALL;
  std::vector<JointNodeEntry> nodes;  ///< at least two
};

/// Reads the options of the effect `joint`: a list of joints, each of
///   kind:  ball or weld; ball if there is none
///   nodes: a list of {fiber, node} or {fiber, at}: a node by its index, first or last; or that at
///   a
///          share of the fibre's length
/// @throws std::invalid_argument naming file, line, field and value, and what is allowed
std::vector<JointEntry> read_joints(const YamlField& list);

/// The shares of their lengths at which fibres have nodes, for those of an entry of `fibers`:
/// rising, each once.
std::vector<double> joint_shares(const std::vector<JointEntry>& joints, const FiberEntry& entry);

/// Finds the nodes of joints, and moves them to the first of each joint: the largest radius there
/// is the most. Checks that all can be joined.
/// @param scene with its effects, fibres and rods; gets the joints
/// @throws std::invalid_argument naming file, line and value, what is allowed, and the fibre
void find_joints(const std::vector<JointEntry>& entries, SimDescription& scene);

/// Checks that holds, on their paths, do not tear what is joined: that joints have places between
/// which, and between which and holds, fibres reach, stretched by max_strain at most. Paths with
/// periods are followed until all begin again together, or for 16 rounds of the longest.
/// @throws std::invalid_argument naming a joint, the holds that tear it together, the time, and by
///         how much they stretch the fibres
void require_holds_in_reach(const SimDescription& scene);

/// Makes the joints of a scene, and closes its closed fibres.
/// @param rods    with twist, have their frames already
/// @param damping of the scene, null for none
/// @returns null if nothing is joined or closed
std::unique_ptr<Joints> make_joints(const SimDescription& scene, Rods& rods,
                                    const std::shared_ptr<const Damping>& damping);

}  // namespace fiber

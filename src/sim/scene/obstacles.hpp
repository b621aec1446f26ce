// The obstacles of a scene, those that stand and those that move.
#pragma once

#include <memory>
#include <optional>

#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "fiber_proximity/sim/scene/scene.hpp"

namespace fiber {

/// Reads the obstacles of a scene, which are all in its frame.
/// @param scene with its effects; gets the obstacles
/// @returns what may touch, by names
/// @throws std::invalid_argument naming file, line and value, and what is allowed
EnvironmentScene read_environment(const std::optional<YamlField>& field, const MeshSource& meshes,
                                  const LinkSource& links, SimDescription& scene);

/// All obstacles as the scene begins, those that move behind the others; without those that follow
/// frames of tf, which are nowhere yet.
std::shared_ptr<const Environment> environment_at_start(const SimDescription& scene);

/// Makes sure that no fibre is inside of an object that appears: no side would be the right one.
/// @throws std::invalid_argument naming fibre, segment and how deep it is in the object
void require_room(const SimDescription& description, const SimScene& scene,
                  const EnvironmentObject& object);

}  // namespace fiber

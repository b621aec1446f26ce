#pragma once

#include "fiber_proximity/sim/scene/scene.hpp"

namespace fiber {

/// Reads the list `effects` of a scene but for its holds: each entry is a name, or a map of a name
/// to the options that are not to be as they are by default.
/// @returns the list of holds, options of the effect attachment; none if there is none
/// @throws std::invalid_argument naming file, line, effect and value, and what is allowed
std::optional<YamlField> read_effects(const YamlField& list, SimDescription& scene);

/// The size of the gravity that a scene names [m/s²]; 0 without.
double gravity_of(const SimDescription& scene);

/// Effects made for the rods of a scene.
struct MadeEffects {
  std::vector<std::unique_ptr<Effect>> effects;
  std::unique_ptr<Contacts> contacts;  ///< null without a contact effect
};

/// Makes the effects that a scene names, and nothing for those it does not name.
/// @param rods   get what the effects need to be with them
/// @param scene  gets attachment, frames and parameters
/// @throws std::invalid_argument naming file and line, for effects that refuse their options
MadeEffects make_effects(const SimDescription& description, Rods& rods, SimScene& scene);

}  // namespace fiber

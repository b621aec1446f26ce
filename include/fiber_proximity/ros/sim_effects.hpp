#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/ros/sim_holds.hpp"
#include "fiber_proximity/ros/sim_parameters.hpp"
#include "fiber_proximity/sim/contacts.hpp"

namespace fiber_proximity_ros {

/// Effects as a scene names them, made for its rods.
struct SimEffects {
  std::vector<std::string> names;  ///< in the order of the scene
  std::vector<std::unique_ptr<fiber::Effect>> effects;
  std::unique_ptr<fiber::Contacts> contacts;  ///< null without a contact effect
  fiber::Attachment* attachment = nullptr;    ///< one of the effects; null without
  std::vector<FollowedFrame> frames;
  double fastest_hold = 0.0;  ///< on a path [m/s]
  SimParameters parameters;   ///< of the effects
};

/// Whether a scene names an effect.
bool has_effect(const std::vector<std::string>& names, const std::string& effect);

/// What effects are made for.
struct SimWorld {
  const std::vector<SimFiber>& fibers;
  std::shared_ptr<const fiber::Environment> environment;  ///< null if the scene has none
  fiber::AllowedPairs allowed;
};

/// Makes the effects of the list `effects` of a scene, and nothing for those it does not name: each
/// entry is a name, or a map of a name to the options that are not to be as they are by default.
/// @param rods get what the effects need to be with them
/// @throws std::invalid_argument naming file, line, effect and value, and what is allowed
SimEffects read_sim_effects(const YamlField& list, const SimWorld& world, fiber::Rods& rods);

/// The size of the gravity that the list names [m/s²], 0 without; whether it names contacts.
/// @throws std::invalid_argument as read_sim_effects
double named_gravity(const YamlField& list);
bool names_contacts(const YamlField& list);

/// Names of all effects.
std::vector<std::string> sim_effect_names();

}  // namespace fiber_proximity_ros

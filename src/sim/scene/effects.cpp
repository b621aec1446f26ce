// How effects are read and made. Which there are and their options: effect_keys.cpp.

#include "fiber_proximity/sim/effects.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "fiber_proximity/sim/contacts.hpp"
#include "src/sim/scene/joints.hpp"
#include "src/sim/scene/keys.hpp"
#include "src/sim/scene/obstacle_motion.hpp"
#include "src/sim/scene/parts.hpp"
#include "src/sim/scene/times.hpp"
#include "src/text/join.hpp"
#include "src/text/quote.hpp"
#include "src/text/with_context.hpp"

namespace fiber {
namespace {

/// All effects, with their numeric options by default.
const std::map<std::string, EffectOptions>& known_effects() {
  static const auto effects = [] {
    std::map<std::string, EffectOptions> known;
    for (const SceneMap& map : scene_maps()) {
      if (!map.is_effect) {
        continue;
      }
      EffectOptions& options = known[map.name];
      for (const SceneKey& key : map.keys) {
        if (!key.numbers.empty()) {
          options[key.name] = key.numbers;
        }
      }
    }
    return known;
  }();
  return effects;
}

/// The keys of an effect that are not options with a number.
std::set<std::string> other_keys(const std::string& effect) {
  std::set<std::string> keys;
  for (const SceneKey& key : keys_of_scene_map(effect)) {
    if (key.numbers.empty()) {
      keys.insert(key.name);
    }
  }
  return keys;
}

/// Reads the options whose names begin with a prefix; the part of a name in front of a dot is a
/// map.
/// @param others keys that are read elsewhere
void read_options(const YamlField& field, const std::string& prefix,
                  const std::set<std::string>& others, EffectOptions& options) {
  std::set<std::string> keys;
  for (const auto& [name, value] : options) {
    if (name.rfind(prefix, 0) == 0) {
      keys.insert(name.substr(prefix.size(), name.find('.', prefix.size()) - prefix.size()));
    }
  }
  std::vector<std::string> allowed(keys.begin(), keys.end());
  allowed.insert(allowed.end(), others.begin(), others.end());
  field.require_map(allowed);
  for (const std::string& key : keys) {
    const auto given = field.find(key);
    const auto option = options.find(prefix + key);
    if (given && option == options.end()) {
      read_options(*given, prefix + key + ".", {}, options);
    } else if (given) {
      const std::size_t count = option->second.size();
      option->second = count == 1 ? std::vector{given->number()} : given->numbers(count);
    }
  }
}

/// An effect, and the field of its options if it has one.
struct Entry {
  SimEffect effect;
  std::optional<YamlField> options;
};

Entry read_entry(const YamlField& entry) {
  const std::vector<YamlField> keys = entry.is_map() ? entry.keys() : std::vector{entry};
  if (keys.size() != 1) {
    entry.refuse("the name of an effect, or a map of one name to options");
  }
  const std::string name = keys.front().text();
  const auto known = known_effects().find(name);
  if (known == known_effects().end()) {
    std::vector<std::string> names;
    for (const auto& [each, options] : known_effects()) {
      names.push_back(each);
    }
    throw std::invalid_argument(keys.front().place() + ": there is no effect " + quote(name) +
                                ", known are: " + join(names));
  }
  return {{name, keys.front().place(), known->second},
          entry.is_map() ? entry.find(name) : std::nullopt};
}

// ---- making effects by their options -----------------------------------------------------------

double number_of(const EffectOptions& options, const char* name) {
  return options.at(name).front();
}

Eigen::Vector3d vector_of(const EffectOptions& options, const char* name) {
  return Eigen::Vector3d(options.at(name).data());
}

Gravity make_gravity(const EffectOptions& options) {
  return Gravity(vector_of(options, "acceleration"));
}

/// @returns none where the acceleration does not change
std::optional<TimeTable<Eigen::Vector3d>> read_gravity_table(const YamlField& field,
                                                             const EffectOptions& options) {
  const auto entries =
      read_table<Eigen::Vector3d>(field, {"acceleration"}, vector_of(options, "acceleration"),
                                  [](const YamlField& entry, Eigen::Vector3d& acceleration) {
                                    entry.read("acceleration", acceleration);
                                    if (!acceleration.allFinite()) {
                                      entry.get("acceleration").refuse("finite");
                                    }
                                  });
  if (!field.find("table")) {
    return std::nullopt;
  }
  return TimeTable<Eigen::Vector3d>(entries, field.find("period").has_value());
}

template <bool is_beside_bend>
Damping make_damping(const EffectOptions& options) {
  return Damping(number_of(options, "relaxation_time"), is_beside_bend);
}

Drag make_drag(const EffectOptions& options) {
  Drag::Options drag;
  drag.fluid_density = number_of(options, "fluid_density");
  drag.across = number_of(options, "across");
  drag.along = number_of(options, "along");
  drag.wind.mean = vector_of(options, "wind.mean");
  drag.wind.gust = vector_of(options, "wind.gust");
  drag.wind.gust_period = number_of(options, "wind.gust_period");
  drag.wind.gust_length = number_of(options, "wind.gust_length");
  return Drag(drag);
}

Friction make_friction(const EffectOptions& options) {
  return Friction({number_of(options, "coefficient"), number_of(options, "stick_speed")});
}

/// Makes an effect of its options, null if the scene does not name it; errors name where it stands.
template <class Make>
auto make(const SimDescription& scene, const char* name, const Make& make_of) {
  const SimEffect* effect = scene.find_effect(name);
  using Made = decltype(make_of(effect->options));
  return effect == nullptr ? Made()
                           : with_context(effect->place, [&] { return make_of(effect->options); });
}

/// Makes an effect whose options may change later. Changed options replace it, which is possible
/// because its state lasts for one step only.
template <class Made>
std::shared_ptr<Made> make_adjustable(const SimDescription& description, const char* name,
                                      Made (*made_by)(const EffectOptions&), SimScene& scene) {
  return make(description, name, [&](const EffectOptions& options) {
    const auto made = std::make_shared<Made>(made_by(options));
    scene.parameters.add(
        name, options, [made, made_by](const EffectOptions& changed) { *made = made_by(changed); });
    return made;
  });
}

std::shared_ptr<Attachment> make_attachment(const SimDescription& description, const Rods& rods,
                                            SimScene& scene) {
  auto attachment =
      make(description, "attachment", [](const auto&) { return std::make_shared<Attachment>(); });
  for (const SimHold& hold : description.holds) {
    with_context(hold.place, [&] {
      const auto kind = hold.is_clamp ? Attachment::Kind::CLAMP : Attachment::Kind::PIN;
      const std::uint32_t id = attachment->add(
          rods, {hold.rod, hold.node, kind, placement_of(hold, description, rods, scene.frames),
                 hold.max_force});
      if (hold.frame) {
        scene.frames.back().hold = id;
        scene.paths.emplace(id, scene.frames.back().path);
      }
      return id;
    });
  }
  scene.attachment = attachment;
  return attachment;
}

/// Turns the cross-sections of rods with twist as their fibres turn to begin with.
void set_spins(const SimDescription& description, Rods& rods) {
  for (std::uint32_t rod = 0; rod < rods.count() && !rods.spins.empty(); ++rod) {
    for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
      rods.spins[i] = description.fibers[rod].angular_velocity.dot(rods.start_tangents[i]);
    }
  }
}

/// Null if the scene names no contact effect.
std::unique_ptr<Contacts> make_contacts(const SimDescription& description, SimScene& scene) {
  std::vector<std::unique_ptr<ContactSource>> sources;
  const auto add = [&](const char* name, const auto& source) {
    auto made = make(
        description, name, [&](const EffectOptions& options) -> std::unique_ptr<ContactSource> {
          return source(number_of(options, "stiffness"), number_of(options, "restitution"));
        });
    if (made != nullptr) {
      sources.push_back(std::move(made));
    }
  };
  add("self_contact", [](double stiffness, double restitution) {
    return std::make_unique<FiberContact>(
        FiberContact::Options{Pairing::SAME_FIBER, stiffness, restitution});
  });
  add("fiber_contact", [](double stiffness, double restitution) {
    return std::make_unique<FiberContact>(
        FiberContact::Options{Pairing::DIFFERENT_FIBERS, stiffness, restitution});
  });
  add("environment_contact", [&](double stiffness, double restitution) {
    return std::make_unique<EnvironmentContact>(
        description.environment,
        EnvironmentContact::Options{stiffness, description.allowed, restitution});
  });
  std::shared_ptr<ObstacleMotions> motions;
  add("environment_contact", [&](double stiffness, double restitution) {
    motions = make_obstacle_motions(description, scene);  // more may come
    return std::make_unique<MovingObstacleContact>(
        motions, EnvironmentContact::Options{stiffness, description.allowed, restitution});
  });
  auto friction = make_adjustable(description, "friction", make_friction, scene);
  return sources.empty() ? nullptr
                         : std::make_unique<Contacts>(std::move(sources), std::move(friction),
                                                      std::move(motions));
}

}  // namespace

EffectLists read_effects(const YamlField& list, SimDescription& scene) {
  std::map<std::string, std::optional<YamlField>> fields;
  for (const YamlField& item : list.items()) {
    auto [effect, options] = read_entry(item);
    if (!fields.emplace(effect.name, options).second) {
      throw std::invalid_argument(item.place() + ": the effect " + quote(effect.name) +
                                  " is there twice");
    }
    const bool is_list =
        effect.name == "attachment" || effect.name == "load" || effect.name == "joint";
    if (effect.name == "joint" && !options) {
      item.refuse("a map of joint to a list of joints");
    }
    if (options && effect.name != "bend" && !is_list) {
      read_options(*options, "", other_keys(effect.name), effect.options);
    }
    if (options && effect.name == "gravity") {
      scene.gravity_in_time = read_gravity_table(*options, effect.options);
    }
    scene.effect_names.push_back(effect.name);
    scene.effects.push_back(std::move(effect));
  }
  const auto refuse = [&scene](const char* name, const char* problem) {
    if (const SimEffect* effect = scene.find_effect(name)) {
      throw std::invalid_argument(effect->place + ": " + problem);
    }
  };
  if (scene.has_effect("stretch")) {
    refuse("inextensible", "it stands in for stretch, name one of them");
  }
  scene.has_contacts = scene.has_effect("self_contact") || scene.has_effect("fiber_contact") ||
                       scene.has_effect("environment_contact");
  if (!scene.has_contacts) {
    refuse("friction",
           "friction is in contacts, name self_contact, fiber_contact or environment_contact, too");
  }
  if (fields["bend"]) {
    scene.natural_curvature = read_natural_curvature(*fields["bend"], scene.has_effect("twist"));
  }
  return {fields["attachment"], fields["load"], fields["joint"]};
}

double gravity_of(const SimDescription& scene) {
  if (scene.gravity_in_time) {
    double largest = 0.0;
    for (const auto& entry : scene.gravity_in_time->entries()) {
      largest = std::max(largest, entry.value.norm());
    }
    return largest;
  }
  const SimEffect* gravity = scene.find_effect("gravity");
  return gravity == nullptr ? 0.0 : vector_of(gravity->options, "acceleration").norm();
}

MadeEffects make_effects(const SimDescription& description, Rods& rods, SimScene& scene) {
  MadeEffects made;
  const auto add = [&made](std::shared_ptr<Effect> effect) {
    if (effect != nullptr) {
      made.effects.push_back(std::move(effect));
    }
  };
  const auto add_fixed = [&](const char* name, const auto& make_of) {
    add(make(description, name, make_of));
  };
  if (description.gravity_in_time) {
    add_fixed("gravity", [&](const auto&) {
      return std::make_unique<GravityInTime>(*description.gravity_in_time);
    });
  } else {
    add(make_adjustable(description, "gravity", make_gravity, scene));
  }
  add_fixed("stretch", [](const auto&) { return std::make_unique<Stretch>(); });
  add_fixed("inextensible", [&](const auto&) { return std::make_unique<Inextensible>(rods); });
  add_fixed("bend", [](const auto&) { return std::make_unique<Bend>(); });
  add_fixed("twist", [&](const auto&) { return std::make_unique<Twist>(rods); });
  // After twist, which gives rods their frames.
  set_spins(description, rods);
  set_natural_curvature(description, rods);
  set_stiff_sides(description, rods);
  add(rods.stiff_sides.empty() ? nullptr : std::make_shared<AnisotropicBend>());
  const SimCurvature& natural = description.natural_curvature;
  const bool bends_to_be_straight = description.has_effect("bend") && natural.curvature == 0.0 &&
                                    !natural.is_from_shape && !description.has_effect("plasticity");
  const std::shared_ptr<Damping> damping =
      make_adjustable(description, "damping",
                      bends_to_be_straight ? make_damping<true> : make_damping<false>, scene);
  add(damping);
  add(make_adjustable(description, "drag", make_drag, scene));
  add_fixed("plasticity", [&](const EffectOptions& options) {
    return std::make_unique<Plasticity>(
        rods,
        Plasticity::Options{number_of(options, "yield_strain"), number_of(options, "hardening")});
  });
  // After twist, which gives rods the directors that clamps hold.
  add(make_attachment(description, rods, scene));
  add(make_loads(description, rods, scene));
  made.contacts = make_contacts(description, scene);
  made.joints = make_joints(description, rods, damping);
  return made;
}

}  // namespace fiber

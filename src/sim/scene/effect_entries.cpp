// How effects are read. Which there are and their options: effect_keys.cpp; how they are made:
// effects.cpp.

#include <algorithm>
#include <set>
#include <stdexcept>

#include "src/sim/scene/keys.hpp"
#include "src/sim/scene/parts.hpp"
#include "src/sim/scene/times.hpp"
#include "src/text/join.hpp"
#include "src/text/quote.hpp"

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
                                ", known are: " + join(names) +
                                (name == "rolling" ? "; fibres roll by twist and friction" : ""));
  }
  return {{name, keys.front().place(), known->second},
          entry.is_map() ? entry.find(name) : std::nullopt};
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

}  // namespace fiber

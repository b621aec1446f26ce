// The one place that knows which effects there are, their options, and how they are made.
#include "src/sim/scene/effects.hpp"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "fiber_proximity/sim/contacts.hpp"
#include "fiber_proximity/sim/effects/bend.hpp"
#include "fiber_proximity/sim/effects/damping.hpp"
#include "fiber_proximity/sim/effects/drag.hpp"
#include "fiber_proximity/sim/effects/environment_contact.hpp"
#include "fiber_proximity/sim/effects/fiber_contact.hpp"
#include "fiber_proximity/sim/effects/friction.hpp"
#include "fiber_proximity/sim/effects/gravity.hpp"
#include "fiber_proximity/sim/effects/inextensible.hpp"
#include "fiber_proximity/sim/effects/plasticity.hpp"
#include "fiber_proximity/sim/effects/stretch.hpp"
#include "fiber_proximity/sim/effects/twist.hpp"
#include "src/sim/scene/holds.hpp"
#include "src/sim/scene/natural_curvature.hpp"
#include "src/text/join.hpp"
#include "src/text/quote.hpp"
#include "src/text/with_context.hpp"

namespace fiber {
namespace {

/// All effects there are, with the numbers that are their options, as they are by default.
const std::map<std::string, EffectOptions>& known_effects() {
  static const auto effects = [] {
    const Drag::Options drag;
    const Friction::Options friction;
    const Plasticity::Options plasticity;
    return std::map<std::string, EffectOptions>{
        {"attachment", {}},
        {"bend", {}},
        {"damping", {{"relaxation_time", {0.01}}}},
        {"drag",
         {{"fluid_density", {drag.fluid_density}},
          {"across", {drag.across}},
          {"along", {drag.along}},
          {"wind.mean", {0.0, 0.0, 0.0}},
          {"wind.gust", {0.0, 0.0, 0.0}},
          {"wind.gust_period", {drag.wind.gust_period}},
          {"wind.gust_length", {drag.wind.gust_length}}}},
        {"environment_contact", {{"stiffness", {0.0}}}},
        {"fiber_contact", {{"stiffness", {0.0}}}},
        {"friction",
         {{"coefficient", {friction.coefficient}}, {"stick_speed", {friction.stick_speed}}}},
        {"gravity", {{"acceleration", {0.0, 0.0, -9.81}}}},
        {"inextensible", {}},
        {"plasticity",
         {{"yield_strain", {plasticity.yield_strain}}, {"hardening", {plasticity.hardening}}}},
        {"self_contact", {{"stiffness", {0.0}}}},
        {"stretch", {}},
        {"twist", {}}};
  }();
  return effects;
}

/// Reads the options whose names begin with a prefix; the part of a name in front of a dot is a
/// map.
void read_options(const YamlField& field, const std::string& prefix, EffectOptions& options) {
  std::set<std::string> keys;
  for (const auto& [name, value] : options) {
    if (name.rfind(prefix, 0) == 0) {
      keys.insert(name.substr(prefix.size(), name.find('.', prefix.size()) - prefix.size()));
    }
  }
  field.require_map({keys.begin(), keys.end()});
  for (const std::string& key : keys) {
    const auto given = field.find(key);
    const auto option = options.find(prefix + key);
    if (given && option == options.end()) {
      read_options(*given, prefix + key + ".", options);
    } else if (given) {
      const std::size_t count = option->second.size();
      option->second = count == 1 ? std::vector{given->number()} : given->numbers(count);
    }
  }
}

/// An effect by its name, and where its options are if it has some.
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

// ---- made by their options ---------------------------------------------------------------------

double number_of(const EffectOptions& options, const char* name) {
  return options.at(name).front();
}

Eigen::Vector3d vector_of(const EffectOptions& options, const char* name) {
  return Eigen::Vector3d(options.at(name).data());
}

Gravity make_gravity(const EffectOptions& options) {
  return Gravity(vector_of(options, "acceleration"));
}

Damping make_damping(const EffectOptions& options) {
  return Damping(number_of(options, "relaxation_time"));
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

/// Makes the effects of a description one by one; errors name where they stand.
class EffectMaker {
 public:
  EffectMaker(const SimDescription& description, Rods& rods, SimScene& scene)
      : description_(description), rods_(rods), scene_(scene) {}

  /// Null if the scene does not name the effect.
  template <class Made, class... Arguments>
  std::unique_ptr<Made> make(const char* name, Arguments&&... arguments) const {
    const SimEffect* effect = description_.find_effect(name);
    if (effect == nullptr) {
      return nullptr;
    }
    return with_context(effect->place, [&] {
      return std::make_unique<Made>(std::forward<Arguments>(arguments)...);
    });
  }

  /// The same of an effect whose numbers may change later: with other numbers it is another effect,
  /// as its state is that of one step, which begins anew.
  template <class Made>
  std::unique_ptr<Made> make_adjustable(const char* name,
                                        Made (*made_by)(const EffectOptions&)) const {
    const SimEffect* effect = description_.find_effect(name);
    if (effect == nullptr) {
      return nullptr;
    }
    auto made = with_context(effect->place,
                             [&] { return std::make_unique<Made>(made_by(effect->options)); });
    scene_.parameters.add(
        name, effect->options,
        [&made = *made, made_by](const EffectOptions& options) { made = made_by(options); });
    return made;
  }

  std::unique_ptr<Effect> make_plasticity() const {
    const SimEffect* effect = description_.find_effect("plasticity");
    Plasticity::Options options;
    if (effect != nullptr) {
      options = {number_of(effect->options, "yield_strain"),
                 number_of(effect->options, "hardening")};
    }
    return make<Plasticity>("plasticity", rods_, options);
  }

  std::unique_ptr<Effect> make_attachment() const {
    auto attachment = make<Attachment>("attachment");
    for (const SimHold& hold : description_.holds) {
      with_context(hold.place, [&] {
        const auto kind = hold.is_clamp ? Attachment::Kind::CLAMP : Attachment::Kind::PIN;
        return attachment->add(
            rods_, {hold.rod, hold.node, kind,
                    placement_of(hold, description_, rods_, scene_.frames), hold.max_force});
      });
    }
    scene_.attachment = attachment.get();
    return attachment;
  }

  /// Null if the scene names no contact effect.
  std::unique_ptr<Contacts> make_contacts() const {
    std::vector<std::unique_ptr<ContactSource>> sources;
    const auto add = [&sources](std::unique_ptr<ContactSource> source) {
      if (source != nullptr) {
        sources.push_back(std::move(source));
      }
    };
    add(make<FiberContact>("self_contact",
                           FiberContact::Options{Pairing::SAME_FIBER, stiffness("self_contact")}));
    add(make<FiberContact>("fiber_contact", FiberContact::Options{Pairing::DIFFERENT_FIBERS,
                                                                  stiffness("fiber_contact")}));
    add(make<EnvironmentContact>(
        "environment_contact", description_.environment,
        EnvironmentContact::Options{stiffness("environment_contact"), description_.allowed}));
    auto friction = make_adjustable("friction", make_friction);
    return sources.empty() ? nullptr
                           : std::make_unique<Contacts>(std::move(sources), std::move(friction));
  }

 private:
  double stiffness(const char* name) const {
    const SimEffect* effect = description_.find_effect(name);
    return effect == nullptr ? 0.0 : number_of(effect->options, "stiffness");
  }

  const SimDescription& description_;
  Rods& rods_;
  SimScene& scene_;
};

}  // namespace

std::optional<YamlField> read_effects(const YamlField& list, SimDescription& scene) {
  std::map<std::string, std::optional<YamlField>> fields;
  for (const YamlField& item : list.items()) {
    auto [effect, options] = read_entry(item);
    if (!fields.emplace(effect.name, options).second) {
      throw std::invalid_argument(item.place() + ": the effect " + quote(effect.name) +
                                  " is there twice");
    }
    if (options && effect.name != "bend" && effect.name != "attachment") {
      read_options(*options, "", effect.options);
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
  return fields["attachment"];
}

double gravity_of(const SimDescription& scene) {
  const SimEffect* gravity = scene.find_effect("gravity");
  return gravity == nullptr ? 0.0 : vector_of(gravity->options, "acceleration").norm();
}

MadeEffects make_effects(const SimDescription& description, Rods& rods, SimScene& scene) {
  const EffectMaker maker(description, rods, scene);
  MadeEffects made;
  const auto add = [&made](std::unique_ptr<Effect> effect) {
    if (effect != nullptr) {
      made.effects.push_back(std::move(effect));
    }
  };
  add(maker.make_adjustable("gravity", make_gravity));
  add(maker.make<Stretch>("stretch"));
  add(maker.make<Inextensible>("inextensible", rods));
  add(maker.make<Bend>("bend"));
  add(maker.make<Twist>("twist", rods));
  set_natural_curvature(description, rods);  // after twist, which gives rods their frames
  add(maker.make_adjustable("damping", make_damping));
  add(maker.make_adjustable("drag", make_drag));
  add(maker.make_plasticity());
  add(maker.make_attachment());  // after twist, which gives rods the directors that clamps hold
  made.contacts = maker.make_contacts();
  return made;
}

}  // namespace fiber

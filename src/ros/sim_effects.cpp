#include "fiber_proximity/ros/sim_effects.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "fiber_proximity/ros/listed.hpp"
#include "fiber_proximity/ros/naming.hpp"
#include "fiber_proximity/ros/sim_natural_curvature.hpp"
#include "fiber_proximity/sim/effects/bend.hpp"
#include "fiber_proximity/sim/effects/damping.hpp"
#include "fiber_proximity/sim/effects/drag.hpp"
#include "fiber_proximity/sim/effects/environment_contact.hpp"
#include "fiber_proximity/sim/effects/fiber_contact.hpp"
#include "fiber_proximity/sim/effects/gravity.hpp"
#include "fiber_proximity/sim/effects/inextensible.hpp"
#include "fiber_proximity/sim/effects/plasticity.hpp"
#include "fiber_proximity/sim/effects/stretch.hpp"
#include "fiber_proximity/sim/effects/twist.hpp"
#include "fiber_proximity/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

/// The effects of a scene by name, and where they stand: with options, or alone.
class NamedEffects {
 public:
  explicit NamedEffects(const YamlField& list) {
    for (const YamlField& entry : list.items()) {
      const std::vector<YamlField> keys = entry.is_map() ? entry.keys() : std::vector{entry};
      if (keys.size() != 1) {
        entry.refuse("the name of an effect, or a map of one name to options");
      }
      const std::string name = keys.front().text();
      const std::vector<std::string> known = sim_effect_names();
      if (std::find(known.begin(), known.end(), name) == known.end()) {
        refuse_name(keys.front(), known);
      }
      const auto options = entry.is_map() ? entry.find(name) : std::nullopt;
      if (!entries_.emplace(name, Entry{keys.front(), options}).second) {
        throw std::invalid_argument(entry.place() + ": the effect " + fiber::quote(name) +
                                    " is there twice");
      }
      names_.push_back(name);
    }
  }

  const std::vector<std::string>& names() const { return names_; }
  bool has(const std::string& name) const { return entries_.count(name) != 0; }
  std::string place(const std::string& name) const { return entries_.at(name).name.place(); }

  /// The options of an effect that is there; none if it stands alone. Their keys must be these.
  std::optional<YamlField> options(const std::string& name,
                                   const std::vector<std::string>& keys) const {
    const std::optional<YamlField>& options = entries_.at(name).options;
    if (options) {
      options->require_map(keys);
    }
    return options;
  }

  const std::optional<YamlField>& list(const std::string& name) const {
    return entries_.at(name).options;
  }

 private:
  struct Entry {
    YamlField name;
    std::optional<YamlField> options;
  };

  [[noreturn]] static void refuse_name(const YamlField& field,
                                       const std::vector<std::string>& known) {
    throw std::invalid_argument(field.place() + ": there is no effect " +
                                fiber::quote(field.text()) + ", known are: " + listed(known));
  }

  std::map<std::string, Entry> entries_;
  std::vector<std::string> names_;
};

void read(const std::optional<YamlField>& options, const char* key, double& value) {
  if (options) {
    if (const auto given = options->find(key)) {
      value = given->number();
    }
  }
}

void read(const std::optional<YamlField>& options, const char* key, Eigen::Vector3d& value) {
  if (options) {
    if (const auto given = options->find(key)) {
      value = given->vector();
    }
  }
}

/// Makes an effect; an error of its names where it stands.
template <class Made, class... Arguments>
std::unique_ptr<Made> make(const NamedEffects& named, const std::string& name,
                           Arguments&&... arguments) {
  return naming(named.place(name),
                [&] { return std::make_unique<Made>(std::forward<Arguments>(arguments)...); });
}

Eigen::Vector3d read_gravity(const NamedEffects& named) {
  Eigen::Vector3d acceleration(0.0, 0.0, -9.81);
  read(named.options("gravity", {"acceleration"}), "acceleration", acceleration);
  return acceleration;
}

std::unique_ptr<fiber::Effect> make_drag(const NamedEffects& named, SimParameters& parameters) {
  fiber::Drag::Options drag;
  const auto options = named.options("drag", {"fluid_density", "across", "along", "wind"});
  read(options, "fluid_density", drag.fluid_density);
  read(options, "across", drag.across);
  read(options, "along", drag.along);
  if (const auto wind = options ? options->find("wind") : std::nullopt) {
    wind->require_map({"mean", "gust", "gust_period", "gust_length"});
    read(wind, "mean", drag.wind.mean);
    read(wind, "gust", drag.wind.gust);
    read(wind, "gust_period", drag.wind.gust_period);
    read(wind, "gust_length", drag.wind.gust_length);
  }
  auto made = make<fiber::Drag>(named, "drag", drag);
  parameters.add(*made, drag);
  return made;
}

std::unique_ptr<fiber::Effect> make_attachment(const NamedEffects& named, const SimWorld& world,
                                               const fiber::Rods& rods, SimEffects& made) {
  auto attachment = std::make_unique<fiber::Attachment>();
  if (const auto& list = named.list("attachment")) {
    SimHolds holds = read_sim_holds(*list, world.fibers, rods);
    for (const SimHold& hold : holds.holds) {
      naming(hold.place, [&] { return attachment->add(rods, hold.hold); });
    }
    made.frames = std::move(holds.frames);
    made.fastest_hold = holds.fastest;
  }
  made.attachment = attachment.get();
  return attachment;
}

std::vector<std::unique_ptr<fiber::ContactSource>> make_sources(const NamedEffects& named,
                                                                const SimWorld& world) {
  std::vector<std::unique_ptr<fiber::ContactSource>> sources;
  const auto add_fibers = [&](const std::string& name, fiber::Pairing pairing) {
    if (named.has(name)) {
      fiber::FiberContact::Options contact;
      contact.pairing = pairing;
      read(named.options(name, {"stiffness"}), "stiffness", contact.stiffness);
      sources.push_back(make<fiber::FiberContact>(named, name, contact));
    }
  };
  add_fibers("self_contact", fiber::Pairing::SAME_FIBER);
  add_fibers("fiber_contact", fiber::Pairing::DIFFERENT_FIBERS);
  if (named.has("environment_contact")) {
    if (world.environment == nullptr) {
      throw std::invalid_argument(named.place("environment_contact") +
                                  ": the scene has no environment to touch");
    }
    fiber::EnvironmentContact::Options contact;
    contact.allowed = world.allowed;
    read(named.options("environment_contact", {"stiffness"}), "stiffness", contact.stiffness);
    sources.push_back(
        make<fiber::EnvironmentContact>(named, "environment_contact", world.environment, contact));
  }
  return sources;
}

std::unique_ptr<fiber::Contacts> make_contacts(const NamedEffects& named, const SimWorld& world,
                                               SimParameters& parameters) {
  std::vector<std::unique_ptr<fiber::ContactSource>> sources = make_sources(named, world);
  std::unique_ptr<fiber::Friction> friction;
  if (named.has("friction")) {
    if (sources.empty()) {
      throw std::invalid_argument(named.place("friction") +
                                  ": friction is in contacts, name self_contact, fiber_contact or "
                                  "environment_contact, too");
    }
    fiber::Friction::Options options;
    const auto given = named.options("friction", {"coefficient", "stick_speed"});
    read(given, "coefficient", options.coefficient);
    read(given, "stick_speed", options.stick_speed);
    friction = make<fiber::Friction>(named, "friction", options);
    parameters.add(*friction, options);
  }
  return sources.empty()
             ? nullptr
             : std::make_unique<fiber::Contacts>(std::move(sources), std::move(friction));
}

}  // namespace

bool has_effect(const std::vector<std::string>& names, const std::string& effect) {
  return std::find(names.begin(), names.end(), effect) != names.end();
}

std::vector<std::string> sim_effect_names() {
  return {"attachment",    "bend",     "damping", "drag",         "environment_contact",
          "fiber_contact", "friction", "gravity", "inextensible", "plasticity",
          "self_contact",  "stretch",  "twist"};
}

double named_gravity(const YamlField& list) {
  const NamedEffects named(list);
  return named.has("gravity") ? read_gravity(named).norm() : 0.0;
}

bool names_contacts(const YamlField& list) {
  const NamedEffects named(list);
  return named.has("self_contact") || named.has("fiber_contact") ||
         named.has("environment_contact");
}

SimEffects read_sim_effects(const YamlField& list, const SimWorld& world, fiber::Rods& rods) {
  const NamedEffects named(list);
  if (named.has("stretch") && named.has("inextensible")) {
    throw std::invalid_argument(named.place("inextensible") +
                                ": it stands in for stretch, name one of them");
  }
  SimEffects made;
  made.names = named.names();
  std::vector<std::unique_ptr<fiber::Effect>>& effects = made.effects;
  if (named.has("gravity")) {
    const Eigen::Vector3d acceleration = read_gravity(named);
    auto gravity = make<fiber::Gravity>(named, "gravity", acceleration);
    made.parameters.add(*gravity, acceleration);
    effects.push_back(std::move(gravity));
  }
  if (named.has("stretch")) {
    named.options("stretch", {});
    effects.push_back(make<fiber::Stretch>(named, "stretch"));
  }
  if (named.has("inextensible")) {
    named.options("inextensible", {});
    effects.push_back(make<fiber::Inextensible>(named, "inextensible", rods));
  }
  if (named.has("bend")) {
    effects.push_back(make<fiber::Bend>(named, "bend"));
  }
  if (named.has("twist")) {
    named.options("twist", {});
    effects.push_back(make<fiber::Twist>(named, "twist", rods));
  }
  if (named.has("bend") && named.list("bend")) {  // after twist, which gives rods their frames
    read_natural_curvature(*named.list("bend"), world.fibers, rods);
  }
  if (named.has("damping")) {
    double relaxation_time = 0.01;
    read(named.options("damping", {"relaxation_time"}), "relaxation_time", relaxation_time);
    auto damping = make<fiber::Damping>(named, "damping", relaxation_time);
    made.parameters.add(*damping, relaxation_time);
    effects.push_back(std::move(damping));
  }
  if (named.has("drag")) {
    effects.push_back(make_drag(named, made.parameters));
  }
  if (named.has("plasticity")) {
    fiber::Plasticity::Options plasticity;
    const auto options = named.options("plasticity", {"yield_strain", "hardening"});
    read(options, "yield_strain", plasticity.yield_strain);
    read(options, "hardening", plasticity.hardening);
    effects.push_back(make<fiber::Plasticity>(named, "plasticity", rods, plasticity));
  }
  if (named.has("attachment")) {  // after twist, which gives rods the directors that clamps hold
    effects.push_back(make_attachment(named, world, rods, made));
  }
  made.contacts = make_contacts(named, world, made.parameters);
  return made;
}

}  // namespace fiber_proximity_ros

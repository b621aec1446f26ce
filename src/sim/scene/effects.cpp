// How effects are made of what is read in effect_entries.cpp.

#include "fiber_proximity/sim/effects.hpp"

#include "fiber_proximity/sim/contacts.hpp"
#include "src/sim/scene/joints.hpp"
#include "src/sim/scene/obstacle_motion.hpp"
#include "src/sim/scene/parts.hpp"
#include "src/text/with_context.hpp"

namespace fiber {
namespace {

Gravity make_gravity(const EffectOptions& options) {
  return Gravity(vector_of(options, "acceleration"));
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

/// @throws std::invalid_argument for a fibre that would only turn about itself, without twist
void require_turns(const SimDescription& description, const Rods& rods) {
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    const SimFiber& fiber = description.fibers[rod];
    const double rate = fiber.angular_velocity.norm();
    const auto goes_along = [&](std::uint32_t node) {
      const Eigen::Vector3d edge = rods.positions[node + 1] - rods.positions[node];
      return fiber.angular_velocity.cross(edge).norm() <= 1e-6 * rate * edge.norm();
    };
    bool turns = rate == 0.0;
    for (std::uint32_t node = rods.first(rod); node + 1 < rods.end(rod); ++node) {
      turns = turns || !goes_along(node);
    }
    if (!turns) {
      with_context(fiber.place, [] {
        throw std::invalid_argument(
            "angular_velocity is along the fibre: cross-sections turn with the effect twist only");
      });
    }
  }
}

/// Turns the cross-sections of rods with twist as their fibres turn to begin with.
void set_spins(const SimDescription& description, Rods& rods) {
  if (rods.spins.empty()) {
    require_turns(description, rods);
  }
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
  add(rods.stiff_sides.empty() || damping == nullptr
          ? nullptr
          : std::make_shared<AnisotropicDamping>(damping));
  add(make_adjustable(description, "drag", make_drag, scene));
  add_fixed("plasticity", [&](const EffectOptions& options) {
    if (!description.has_effect("bend")) {
      throw std::invalid_argument(
          "plasticity: it is bending that yields, name the effect bend, too");
    }
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

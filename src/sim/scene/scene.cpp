#include "fiber_proximity/sim/scene/scene.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "src/sim/overlaps.hpp"
#include "src/sim/scene/joints.hpp"
#include "src/sim/scene/keys.hpp"
#include "src/sim/scene/obstacle_motion.hpp"
#include "src/sim/scene/obstacles.hpp"
#include "src/sim/scene/parts.hpp"
#include "src/sim/scene/reach.hpp"
#include "src/sim/scene/resolution.hpp"
#include "src/text/join.hpp"
#include "src/text/quote.hpp"

namespace fiber {

namespace {

/// Largest magnitude of parameters in SI units: beyond all use, and far from overflow.
constexpr double max_magnitude = 1e6;

/// Longer values are cut off in errors.
constexpr std::size_t max_characters = 80;

std::string text_of(const std::vector<double>& value) {
  std::string text;
  for (const double number : value) {
    text += (text.empty() ? "" : ", ") + std::to_string(number);
    if (text.size() > max_characters) {
      text = text.substr(0, max_characters) + "...";
      break;
    }
  }
  return "[" + text + "]";
}

[[noreturn]] void refuse(const SimParameter& parameter, const std::string& problem) {
  throw std::invalid_argument("parameter " + quote(parameter.name) + " is " +
                              text_of(parameter.value) + ": " + problem);
}

}  // namespace

void SimParameters::add(const std::string& effect, const EffectOptions& options,
                        std::function<void(const EffectOptions&)> apply) {
  effects_[effect] = {options, std::move(apply)};
}

void SimParameters::set_one(const SimParameter& parameter) {
  const std::size_t dot = parameter.name.find('.');
  const auto effect = effects_.find(parameter.name.substr(0, dot));
  const std::string option = dot == std::string::npos ? "" : parameter.name.substr(dot + 1);
  if (effect == effects_.end() || effect->second.options.count(option) == 0) {
    std::vector<std::string> names;
    for (const SimParameter& known : all()) {
      names.push_back(known.name);
    }
    refuse(parameter, names.empty() ? "the scene names no effect that has parameters"
                                    : "there is no such parameter, known are: " + join(names));
  }
  std::vector<double>& value = effect->second.options.at(option);
  if (parameter.value.size() != value.size()) {
    refuse(parameter, "it must be a list of " + std::to_string(value.size()) + " number(s)");
  }
  for (const double number : parameter.value) {
    if (!(std::abs(number) <= max_magnitude)) {
      refuse(parameter, "its numbers must be finite and at most 1e6 in magnitude");
    }
  }
  value = parameter.value;
  try {
    effect->second.apply(effect->second.options);
  } catch (const std::invalid_argument& error) {
    refuse(parameter, error.what());
  }
}

void SimParameters::set(const std::vector<SimParameter>& parameters) {
  const std::map<std::string, Entry> before = effects_;
  try {
    for (const SimParameter& parameter : parameters) {
      set_one(parameter);
    }
  } catch (const std::invalid_argument&) {
    effects_ = before;
    for (const auto& [name, effect] : effects_) {
      effect.apply(effect.options);
    }
    throw;
  }
}

std::vector<SimParameter> SimParameters::all() const {
  std::vector<SimParameter> parameters;
  for (const auto& [effect, entry] : effects_) {
    for (const auto& [option, value] : entry.options) {
      parameters.push_back({std::string(effect).append(".").append(option), value});
    }
  }
  return parameters;
}

namespace {

/// The number of overlaps up to which the error counts them.
constexpr std::uint32_t max_counted = 1000;

OverlapFinder make_finder(const SimDescription& scene) {
  OverlapFinder::Options options;
  options.same_fiber = scene.has_effect("self_contact");
  options.different_fibers = scene.has_effect("fiber_contact");
  if (scene.has_effect("environment_contact")) {
    options.environment = environment_at_start(scene);
    options.allowed = scene.allowed;
  }
  return OverlapFinder(options);
}

std::string describe(const std::vector<Overlap>& overlaps, const SimDescription& scene,
                     const Rods& rods) {
  const Overlap& deepest = overlaps.front();
  const Contact& contact = deepest.contact;
  const SimFiber& a = scene.fibers[contact.fiber_a];
  const std::string segment_a = format("segment ", contact.segment_a, " of fibre ", quote(a.name));
  const auto radius_of = [&](std::uint32_t rod, std::uint32_t segment) {
    return rods.edge_radius(rod, rods.first(rod) + segment);
  };
  double touching = radius_of(contact.fiber_a, contact.segment_a);
  std::string other;
  if (deepest.is_object) {
    other = format("obstacle ", quote(environment_at_start(scene)->objects()[contact.fiber_b].name),
                   ": ", segment_a, " is ");
  } else {
    const SimFiber& b = scene.fibers[contact.fiber_b];
    touching += radius_of(contact.fiber_b, contact.segment_b);
    other = format(contact.fiber_a == contact.fiber_b ? "itself" : b.place, ": ", segment_a,
                   " and segment ", contact.segment_b, " of fibre ", quote(b.name), " are ");
  }
  const std::string more =
      overlaps.size() == 1 ? ""
                           : format("; so are ", overlaps.size() < max_counted ? "" : "at least ",
                                    overlaps.size() - 1, " more pairs");
  return format(a.place, " begins inside of ", other, 1e3 * deepest.depth(), " mm deep in it, ",
                1e3 * touching_share * touching, " mm is the most", more);
}

/// The largest displacement of nodes and strain of edges by the separation, for the log.
std::string describe_move(const std::vector<Eigen::Vector3d>& before, const Rods& rods,
                          std::size_t count) {
  double farthest = 0.0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    farthest = std::max(farthest, (rods.positions[i] - before[i]).norm());
  }
  return format("initial_overlap: ", count,
                " pair(s) of segments began inside of each other; nodes were moved by up to ",
                1e3 * farthest, " mm, which stretches edges by up to ",
                100.0 * largest_strain(rods).strain, " %");
}

std::vector<bool> held_nodes(const Attachment* attachment, const Rods& rods) {
  std::vector<bool> is_held(rods.positions.size(), false);
  if (attachment != nullptr) {
    for (const auto& [rod, node] : attachment->held_nodes()) {
      is_held[rods.first(rod) + node] = true;
    }
  }
  return is_held;
}

}  // namespace

std::string resolve_overlaps(const SimDescription& scene, const Attachment* attachment,
                             Rods& rods) {
  OverlapFinder finder = make_finder(scene);
  const std::vector<Overlap> overlaps = finder.find(rods, touching_share, max_counted);
  if (overlaps.empty()) {
    return "";
  }
  if (!scene.separates_overlaps) {
    throw std::invalid_argument(describe(overlaps, scene, rods) +
                                "; move them apart, or have `initial_overlap: separate`");
  }
  const std::vector<Eigen::Vector3d> before = rods.positions;
  const std::vector<Overlap> left = separate_overlaps(rods, finder, held_nodes(attachment, rods));
  if (!left.empty()) {
    throw std::invalid_argument(describe(left, scene, rods) +
                                ", where `initial_overlap: separate` has moved them: there may be "
                                "no room, or what holds them is in the way");
  }
  return describe_move(before, rods, overlaps.size());
}

namespace {

/// Reads a number within its limits, if the key is there.
void read_within(const YamlField& document, const char* key, double& value) {
  const auto field = document.find(key);
  if (!field) {
    return;
  }
  value = field->number();
  const KeyLimits& limits = key_limits("scene", key);
  if (!limits.contain(value)) {
    field->refuse(limits.text());
  }
}

void read_stepper_options(const YamlField& document, StepperOptions& options) {
  if (const auto iterations = document.find("iterations")) {
    options.max_iterations =
        static_cast<std::uint32_t>(iterations->integer(1, max_step_iterations));
  }
  read_within(document, "residual", options.residual);
  if (read_choice(document.find("integrator"), "implicit_euler", "bdf2")) {
    options.integrator = Integrator::BDF2;
  }
}

}  // namespace

bool SimSettings::has_effect(const std::string& name) const {
  return std::find(effect_names.begin(), effect_names.end(), name) != effect_names.end();
}

const SimEffect* SimDescription::find_effect(const std::string& name) const {
  const auto found = std::find_if(effects.begin(), effects.end(),
                                  [&name](const SimEffect& effect) { return effect.name == name; });
  return found == effects.end() ? nullptr : &*found;
}

SimDescription read_sim_scene(const YamlField& document, const MeshSource& meshes,
                              const FrameTimer& timer, const LinkSource& links) {
  document.require_map(key_names("scene"));
  SimDescription scene;
  if (const auto frame_id = document.find("frame_id")) {
    scene.frame_id = frame_id->text();
  }
  read_within(document, "time_step", scene.time_step);
  read_within(document, "max_strain", scene.max_strain);
  const EffectLists lists = read_effects(document.get("effects"), scene);
  read_stepper_options(document, scene.options);
  const std::vector<JointEntry> joints =
      lists.joints ? read_joints(*lists.joints) : std::vector<JointEntry>();
  const SceneResolution resolution(document, gravity_of(scene), joints);
  const EnvironmentScene environment =
      read_environment(document.find("environment"), meshes, links, scene);
  scene.separates_overlaps = read_choice(document.find("initial_overlap"), "refuse", "separate");
  const auto complete = [&](SimDescription& made) {
    made.allowed = resolve(environment.allowed, made.fiber_names);
    find_joints(joints, made);
    if (lists.holds) {
      read_holds(*lists.holds, made);
      require_holds_in_reach(made);
    }
    if (lists.loads) {
      read_loads(*lists.loads, made);
    }
  };
  SimDescription made = resolution.apply(scene, complete, timer);
  require_slow_turns(made);
  return made;
}

void SimScene::advance() {
  frame = StepReport();
  for (std::uint32_t i = 0; i < substeps; ++i) {
    stepper->step(step_length());
    const StepReport& step = stepper->report();
    if (i == 0 || !(step.worst.residual <= frame.worst.residual)) {
      frame.worst = step.worst;
    }
    frame.energy_gain = i == 0 ? step.energy_gain : std::max(frame.energy_gain, step.energy_gain);
    frame.iterations = std::max(frame.iterations, step.iterations);
    frame.unbalanced += step.unbalanced;
    frame.coupled_rods = std::max(frame.coupled_rods, step.coupled_rods);
    frame.impacts += step.impacts;
    frame.is_first_order = frame.is_first_order || step.is_first_order;
  }
}

namespace {

/// Makes a scene.
/// @param resolve called with scene and rods, when all is made but the stepper
template <class Resolve>
SimScene make_scene(const SimDescription& description, std::uint32_t threads,
                    const Resolve& resolve) {
  SimScene scene(description);
  scene.options.threads = threads;
  Rods rods = description.rods;
  MadeEffects effects = make_effects(description, rods, scene);
  resolve(scene, rods);
  scene.stepper =
      std::make_unique<Stepper>(std::move(rods), std::move(effects.effects), scene.options,
                                std::move(effects.contacts), std::move(effects.joints));
  return scene;
}

}  // namespace

SimScene make_sim_scene(const SimDescription& description, std::uint32_t threads) {
  return make_scene(description, threads, [&](SimScene& scene, Rods& rods) {
    scene.overlap_note = resolve_overlaps(description, scene.attachment.get(), rods);
  });
}

SimScene copy_sim_scene(const SimDescription& description, const SimScene& scene,
                        std::uint32_t threads) {
  SimScene copy = make_scene(description, threads, [](SimScene& /*scene*/, Rods& /*rods*/) {});
  copy.overlap_note = scene.overlap_note;
  copy.parameters.set(scene.parameters.all());
  copy_added_obstacles(scene, copy);
  copy.stepper->take_state(*scene.stepper);
  copy.paths.clear();
  for (const auto& [hold, path] : scene.paths) {
    const auto own = std::make_shared<const PlacementPath>(*path);
    copy.attachment->redirect(hold, [own](double time) { return placement_at(*own, time); });
    copy.paths.emplace(hold, own);
  }
  copy_obstacle_frames(scene, copy);
  return copy;
}

}  // namespace fiber

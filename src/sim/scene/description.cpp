#include "fiber_proximity/sim/scene/description.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "src/environment/scene/environment_scene.hpp"
#include "src/sim/scene/effects.hpp"
#include "src/sim/scene/holds.hpp"
#include "src/sim/scene/resolution.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

/// [s] A timer calls for frames, which needs some time itself.
constexpr double shortest_frame = 1e-6;
constexpr double longest_frame = 1000.0;

constexpr std::int64_t most_iterations = 1000;

/// [m/s] Smaller ones are rounding errors, with larger ones nothing would ever move.
constexpr double least_residual = 1e-9;
constexpr double most_residual = 1.0;

/// Reads a number above 0, and from the least to the most, if there is one.
void read_within(const YamlField& document, const char* key, double least, double most,
                 double& value) {
  const auto field = document.find(key);
  if (!field) {
    return;
  }
  value = field->number();
  if (!(value > 0.0 && value >= least && value <= most)) {
    std::ostringstream allowed;
    allowed << (least > 0.0 ? "at least " : "above ") << least << " and at most " << most;
    field->refuse(allowed.str());
  }
}

void read_stepper_options(const YamlField& document, StepperOptions& options) {
  if (const auto iterations = document.find("iterations")) {
    options.max_iterations = static_cast<std::uint32_t>(iterations->integer(1, most_iterations));
  }
  read_within(document, "residual", least_residual, most_residual, options.residual);
  if (const auto integrator = document.find("integrator")) {
    if (integrator->text() == "bdf2") {
      options.integrator = Integrator::BDF2;
    } else if (integrator->text() != "implicit_euler") {
      integrator->refuse("implicit_euler or bdf2");
    }
  }
}

bool read_separates_overlaps(const std::optional<YamlField>& field) {
  if (!field || field->text() == "refuse") {
    return false;
  }
  if (field->text() != "separate") {
    field->refuse("refuse or separate");
  }
  return true;
}

/// Reads the obstacles of a scene, which are all in its frame: nothing moves them.
void read_environment(const std::optional<YamlField>& field, const MeshSource& meshes,
                      SimDescription& scene) {
  const SimEffect* contact = scene.find_effect("environment_contact");
  if (!field && contact != nullptr) {
    throw std::invalid_argument(contact->place + ": the scene has no environment to touch");
  }
  const EnvironmentScene read = field ? read_environment_scene(*field, meshes) : EnvironmentScene();
  std::vector<EnvironmentObject> objects;
  for (const SceneObstacle& obstacle : read.obstacles) {
    if (!obstacle.frame_id.empty() && obstacle.frame_id != scene.frame_id) {
      throw std::invalid_argument(field->place() + ": obstacle " + quote(obstacle.object.name) +
                                  " is in frame " + quote(obstacle.frame_id) +
                                  ", it must be in the scene's, " + quote(scene.frame_id));
    }
    objects.push_back(obstacle.object);
  }
  scene.environment = std::make_shared<const Environment>(std::move(objects));
  scene.allowed = resolve(read.allowed, scene.fiber_names);
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

SimDescription read_sim_scene(const YamlField& document, const MeshSource& meshes) {
  document.require_map({"frame_id", "time_step", "substeps", "iterations", "residual", "integrator",
                        "accuracy", "real_time", "fibers", "effects", "environment",
                        "initial_overlap", "max_strain"});
  SimDescription scene;
  if (const auto frame_id = document.find("frame_id")) {
    scene.frame_id = frame_id->text();
  }
  read_within(document, "time_step", shortest_frame, longest_frame, scene.time_step);
  read_within(document, "max_strain", 0.0, 10.0, scene.max_strain);
  const auto holds = read_effects(document.get("effects"), scene);
  read_stepper_options(document, scene.options);
  read_resolution(document, gravity_of(scene), scene);
  read_environment(document.find("environment"), meshes, scene);
  if (holds) {
    read_holds(*holds, scene);
  }
  scene.separates_overlaps = read_separates_overlaps(document.find("initial_overlap"));
  return scene;
}

}  // namespace fiber

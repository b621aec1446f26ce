#include "fiber_proximity/ros/sim_scene.hpp"

#include <sstream>
#include <stdexcept>

#include "fiber_proximity/ros/allowed_contacts.hpp"
#include "fiber_proximity/ros/environment_scene.hpp"
#include "fiber_proximity/ros/load_yaml.hpp"
#include "fiber_proximity/ros/sim_overlap.hpp"
#include "fiber_proximity/ros/sim_resolution.hpp"
#include "fiber_proximity/ros/yaml_obstacle.hpp"
#include "fiber_proximity/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

/// [s] A timer calls for frames, which needs some time itself.
constexpr double shortest_frame = 1e-6;
constexpr double longest_frame = 1000.0;

constexpr std::int64_t most_iterations = 100;

std::uint32_t read_count(const YamlField& document, const char* key, std::int64_t most,
                         std::uint32_t count) {
  const auto field = document.find(key);
  return field ? static_cast<std::uint32_t>(field->integer(1, most)) : count;
}

/// A number above 0, and from the least to the most.
double read_within(const YamlField& document, const char* key, double least, double most,
                   double value) {
  const auto field = document.find(key);
  if (!field) {
    return value;
  }
  const double number = field->number();
  if (!(number > 0.0 && number >= least && number <= most)) {
    std::ostringstream allowed;
    allowed << (least > 0.0 ? "at least " : "above ") << least << " and at most " << most;
    field->refuse(allowed.str());
  }
  return number;
}

fiber::StepperOptions read_options(const YamlField& document, bool has_contacts) {
  fiber::StepperOptions options;
  options.iterations = read_count(document, "iterations", most_iterations, options.iterations);
  if (const auto integrator = document.find("integrator")) {
    if (integrator->text() == "implicit_midpoint") {
      if (has_contacts) {
        integrator->refuse("implicit_euler where there are contacts");
      }
      options.integrator = fiber::Integrator::IMPLICIT_MIDPOINT;
    } else if (integrator->text() != "implicit_euler") {
      integrator->refuse("implicit_euler or implicit_midpoint");
    }
  }
  return options;
}

/// The obstacles of a scene, which are all in its frame: nothing moves them.
std::shared_ptr<const fiber::Environment> make_environment(const YamlField& field,
                                                           const EnvironmentScene& scene,
                                                           const std::string& frame_id) {
  fiber::World world;
  for (const FramedChange& obstacle : scene.obstacles) {
    const std::string& frame = obstacle.header.frame_id;
    if (!frame.empty() && frame != frame_id) {
      std::ostringstream error;
      error << field.place() << ": obstacle " << fiber::quote(obstacle.change.object.name)
            << " is in frame " << fiber::quote(frame) << ", it must be in the scene's, "
            << fiber::quote(frame_id);
      throw std::invalid_argument(error.str());
    }
    world.apply({obstacle.change});
  }
  return world.environment();
}

/// The same obstacles as messages, for others that are to know them.
std::vector<fiber_proximity::Obstacle> read_obstacles(const YamlField& environment,
                                                      const MeshLoader& meshes,
                                                      const std::string& frame_id) {
  std::vector<fiber_proximity::Obstacle> obstacles;
  if (const auto list = environment.find("obstacles")) {
    for (const YamlField& entry : list->items()) {
      obstacles.push_back(read_obstacle(entry, meshes));
      obstacles.back().header.frame_id = frame_id;
    }
  }
  return obstacles;
}

fiber::AllowedPairs resolve(const std::vector<fiber_proximity::AllowedPair>& pairs,
                            const std::vector<std::string>& fiber_names) {
  AllowedContacts allowed;
  fiber_proximity::AllowPairs::Request request;
  request.allow = pairs;
  allowed.apply(request);
  return allowed.resolve(fiber_names);
}

}  // namespace

SimScene read_sim_scene(const std::string& file, const MeshLoader& meshes, std::uint32_t threads,
                        std::optional<std::uint32_t> iterations) {
  return read_sim_scene(load_yaml(file), meshes, threads, iterations);
}

SimScene read_sim_scene(const YamlField& document, const MeshLoader& meshes, std::uint32_t threads,
                        std::optional<std::uint32_t> iterations) {
  document.require_map({"frame_id", "time_step", "substeps", "iterations", "integrator", "accuracy",
                        "real_time", "fibers", "effects", "environment", "initial_overlap",
                        "max_strain"});
  SimScene scene;
  const auto frame_id = document.find("frame_id");
  scene.frame_id = frame_id ? frame_id->text() : "world";
  scene.time_step =
      read_within(document, "time_step", shortest_frame, longest_frame, scene.time_step);
  scene.max_strain = read_within(document, "max_strain", 0.0, 10.0, scene.max_strain);
  scene.has_contacts = names_contacts(document.get("effects"));
  scene.options = read_options(document, scene.has_contacts);
  scene.options.threads = threads;
  scene.options.iterations = iterations.value_or(scene.options.iterations);
  SimSteps steps;
  steps.time_step = scene.time_step;
  if (document.find("substeps")) {
    steps.substeps = read_count(document, "substeps", most_substeps, scene.substeps);
  }
  steps.options = scene.options;
  steps.gravity = named_gravity(document.get("effects"));
  steps.has_contacts = scene.has_contacts;
  const SimResolution resolution = read_sim_resolution(document, steps);
  const std::vector<SimFiber>& fibers = resolution.fibers;
  scene.substeps = resolution.substeps;
  scene.accuracy = resolution.accuracy;
  fiber::Rods rods;
  for (const SimFiber& fiber : fibers) {
    rods.add(fiber.points, fiber.radius, fiber.section);
    scene.fiber_names.push_back(fiber.name);
  }
  SimWorld world{fibers, nullptr, {}};
  if (const auto field = document.find("environment")) {
    const EnvironmentScene environment = read_scene(*field, meshes);
    world.environment = make_environment(*field, environment, scene.frame_id);
    world.allowed = resolve(environment.allowed, scene.fiber_names);
    scene.obstacles = read_obstacles(*field, meshes, scene.frame_id);
  }
  SimEffects effects = read_sim_effects(document.get("effects"), world, rods);
  scene.overlap_note = read_initial_overlap(document, world, effects, rods);
  scene.effect_names = std::move(effects.names);
  scene.attachment = effects.attachment;
  scene.frames = std::move(effects.frames);
  scene.parameters = std::move(effects.parameters);
  scene.fastest_hold = effects.fastest_hold;
  scene.stepper = std::make_unique<fiber::Stepper>(std::move(rods), std::move(effects.effects),
                                                   scene.options, std::move(effects.contacts));
  return scene;
}

}  // namespace fiber_proximity_ros

#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/Obstacle.h"
#include "fiber_proximity/ros/mesh_loader.hpp"
#include "fiber_proximity/ros/sim_effects.hpp"
#include "fiber_proximity/ros/yaml_field.hpp"
#include "fiber_proximity/sim/stepper.hpp"

namespace fiber_proximity_ros {

/// A scene of the simulation, ready to move.
struct SimScene {
  std::string frame_id;
  std::vector<std::string> fiber_names;
  std::vector<std::string> effect_names;
  double time_step = 1.0 / 60.0;  ///< from frame to frame [s]
  std::uint32_t substeps = 4;     ///< of a frame
  fiber::StepperOptions options;
  std::optional<double> accuracy;  ///< by which segments and substeps were chosen; none: given
  bool has_contacts = false;
  std::unique_ptr<fiber::Stepper> stepper;
  fiber::Attachment* attachment = nullptr;           ///< of the stepper; null without the effect
  std::vector<FollowedFrame> frames;                 ///< whose placements are to be kept up to date
  std::vector<fiber_proximity::Obstacle> obstacles;  ///< of its environment
  SimParameters parameters;                          ///< of its effects
  double fastest_hold = 0.0;                         ///< on a path [m/s]

  /// By how much of their length what holds fibres may stretch them where the scene does not say
  /// itself how it moves: ~attach, handles and frames of tf.
  double max_strain = 0.1;

  std::string overlap_note;  ///< what was moved before the beginning; empty if nothing was
};

/// Reads a scene from a YAML file with the keys fibers, effects, environment (as the node's scene
/// has it), frame_id, time_step, substeps, iterations, integrator, accuracy, real_time,
/// initial_overlap, max_strain.
/// @param threads    most to use, 0 for as many as there are cores
/// @param iterations in place of the scene's
/// @throws std::invalid_argument naming file, line, field and value, and what is allowed
SimScene read_sim_scene(const std::string& file, const MeshLoader& meshes, std::uint32_t threads,
                        std::optional<std::uint32_t> iterations = std::nullopt);

/// The same from a document.
SimScene read_sim_scene(const YamlField& document, const MeshLoader& meshes, std::uint32_t threads,
                        std::optional<std::uint32_t> iterations = std::nullopt);

}  // namespace fiber_proximity_ros

#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/environment/scene/mesh_files.hpp"
#include "fiber_proximity/sim/rods.hpp"
#include "fiber_proximity/sim/stepper.hpp"
#include "fiber_proximity/yaml/yaml_field.hpp"

namespace fiber {

/// What a scene of the simulation says of itself as a whole.
struct SimSettings {
  std::string frame_id = "world";
  std::vector<std::string> fiber_names;  ///< of the rods
  std::vector<std::string> effect_names;
  double time_step = 1.0 / 60.0;  ///< from frame to frame [s]
  std::uint32_t substeps = 4;     ///< of a frame
  StepperOptions options;
  std::optional<double> accuracy;  ///< by which segments and substeps were chosen; none: given
  bool has_contacts = false;
  double fastest_hold = 0.0;  ///< on a path [m/s]

  /// By how much of their length what holds fibres may stretch them where the scene does not say
  /// itself how it moves: ~attach, handles and frames of tf.
  double max_strain = 0.1;

  std::shared_ptr<const Environment> environment;  ///< never null

  bool has_effect(const std::string& name) const;
  double step_length() const { return time_step / substeps; }  ///< [s]
};

/// The fibre of a rod. Places are where something stands in the file, for errors.
struct SimFiber {
  std::string name;
  std::string group;  ///< name of the entry it comes from
  std::string place;
};

/// Numbers of an effect by the names of its options; of an option that is a map itself, the name is
/// in front: wind.mean.
using EffectOptions = std::map<std::string, std::vector<double>>;

/// An effect that a scene names.
struct SimEffect {
  std::string name;
  std::string place;
  EffectOptions options;  ///< all there are, as the scene has them or by default
};

/// Options of the effect `bend`.
struct SimCurvature {
  bool is_from_shape = false;
  double curvature = 0.0;                  ///< [1/m]
  std::optional<Eigen::Vector3d> towards;  ///< to which side the first edge of each fibre bends
  std::string towards_statement;           ///< with which a refusal of that begins
};

/// How a fibre is held at a time.
struct SimWaypoint {
  double time;                              ///< [s]
  Eigen::Vector3d position;                 ///< [m]
  Eigen::Vector3d tangent;                  ///< of unit length
  std::optional<Eigen::Vector3d> director;  ///< none: as before, or as the cross-section lies
};

/// What holds a node of a rod.
struct SimHold {
  std::string place;
  std::uint32_t rod = 0;
  std::uint32_t node = 0;  ///< from the rod's first one
  bool is_clamp = false;
  std::vector<SimWaypoint> path;     ///< times rise from 0; never empty
  bool is_periodic = false;          ///< from the last waypoint on, the path begins again
  std::optional<std::string> frame;  ///< of tf, in which the only waypoint is
  double max_force = 0.0;            ///< [N] with which it pulls at most; 0: by the material
};

/// All that a scene says, checked as far as that goes without making it.
struct SimDescription : SimSettings {
  Rods rods;  ///< as they lie in the file
  std::vector<SimFiber> fibers;
  std::vector<SimEffect> effects;  ///< in the order of the scene
  SimCurvature natural_curvature;
  std::vector<SimHold> holds;
  AllowedPairs allowed;             ///< fibres and objects that may touch
  bool separates_overlaps = false;  ///< moves fibres apart that begin inside of something

  /// Null if the scene does not name it.
  const SimEffect* find_effect(const std::string& name) const;
};

/// Reads a scene with the keys fibers, effects, environment (read_environment_scene()), frame_id,
/// time_step, substeps, iterations, residual, integrator, accuracy, real_time, initial_overlap,
/// max_strain.
/// docs/simulation.md says what they mean.
/// @throws std::invalid_argument naming file, line, field and value, and what is allowed; and the
///         fibre where it is about one
SimDescription read_sim_scene(const YamlField& document, const MeshSource& meshes);

}  // namespace fiber

#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "fiber_proximity/sim/attachment.hpp"
#include "fiber_proximity/sim/joints.hpp"
#include "fiber_proximity/sim/loads.hpp"
#include "fiber_proximity/sim/moving_obstacles.hpp"
#include "fiber_proximity/sim/stepper.hpp"
#include "fiber_proximity/yaml/yaml_field.hpp"

namespace fiber {

/// The settings of a scene of the simulation as a whole.
struct SimSettings {
  std::string frame_id = "world";
  std::vector<std::string> fiber_names;  ///< of the rods
  std::vector<std::string> effect_names;
  double time_step = 1.0 / 60.0;  ///< from frame to frame [s]
  std::uint32_t substeps = 4;     ///< of a frame
  StepperOptions options;
  std::optional<double> accuracy;  ///< for which segments and substeps were chosen; none: given
  bool has_contacts = false;
  std::size_t moving_count = 0;  ///< of obstacles that move
  double fastest_hold = 0.0;     ///< on a path [m/s]

  /// The strain up to which holds may stretch fibres where the scene does not give their paths:
  /// those of ~attach, handles and frames of tf.
  double max_strain = 0.1;

  std::shared_ptr<const Environment> environment;  ///< what stands still; never null

  /// Sentences: what materials leave open, and what is taken for it.
  std::vector<std::string> material_defaults;

  /// Sentences of scenes with `real_time`: what was chosen, and what share of the time there is it
  /// takes. It is the warning where that is more than the share that was aimed at.
  std::string real_time_note;
  std::string real_time_warning;

  bool has_effect(const std::string& name) const;
  double step_length() const { return time_step / substeps; }  ///< [s]
};

/// Towards which side a fibre's material is stiffer, if any is.
struct SimStiffSide {
  Eigen::Vector3d towards;  ///< of its first segment; of any length
  std::string statement;    ///< where it stands and what it is, for errors
};

/// The fibre of a rod. Places are lines and fields of the file, for errors.
struct SimFiber {
  std::string name;
  std::string group;  ///< name of the entry it comes from
  std::string place;
  double length = 0.0;  ///< of its shape, before it is cut into segments [m]
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< to begin with [rad/s]

  /// The nodes by the shares of the length at which joints name them.
  std::map<double, std::uint32_t> nodes_at;

  std::optional<SimStiffSide> stiff_side;
};

/// The numbers of an effect by the names of its options. Names of options in a map begin with that
/// of the map: wind.mean.
using EffectOptions = std::map<std::string, std::vector<double>>;

/// An effect that a scene names.
struct SimEffect {
  std::string name;
  std::string place;
  EffectOptions options;  ///< all, by the scene or by default
};

/// Options of the effect `bend`.
struct SimCurvature {
  bool is_from_shape = false;
  double curvature = 0.0;                  ///< [1/m]
  std::optional<Eigen::Vector3d> towards;  ///< the side to which the first edge of each fibre bends
  std::string towards_statement;           ///< the beginning of an error about that
};

/// The position and orientation of a hold at a time.
struct SimWaypoint {
  double time;                              ///< [s]
  Eigen::Vector3d position;                 ///< [m]
  Eigen::Vector3d tangent;                  ///< of unit length
  std::optional<Eigen::Vector3d> director;  ///< none: as before, or as the cross-section lies
};

/// A hold of a node of a rod.
struct SimHold {
  std::string place;
  std::uint32_t rod = 0;
  std::uint32_t node = 0;  ///< from the rod's first one
  bool is_clamp = false;
  std::vector<SimWaypoint> path;     ///< times rise from 0; never empty
  bool is_periodic = false;          ///< from the last waypoint on, the path begins again
  std::optional<std::string> frame;  ///< of tf, in which the only waypoint is
  double max_force = 0.0;            ///< with which it pulls [N]; 0: by the material
};

/// A load on a rod.
struct SimLoad {
  std::string place;
  std::uint32_t entry = 0;  ///< of the list, counted from 0; that of a repeated fibre has several
  Loads::Load load;
  std::vector<std::string> parameters;  ///< force, moment, torque: those that are given once
};

/// The pose of an obstacle at a time.
struct SimObstacleWaypoint {
  double time;               ///< [s]
  Eigen::Vector3d position;  ///< of its origin [m]
  Eigen::Quaterniond orientation;
  double angle;  ///< by which it is turned beyond that about the axis of the motion [rad]
};

/// An obstacle that moves.
struct SimMovingObstacle {
  std::string place;
  EnvironmentObject object;
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< of `angle`, in the object's frame
  std::vector<SimObstacleWaypoint> path;            ///< times rise from 0; never empty
  bool is_periodic = false;          ///< from the last waypoint on, the path begins again
  std::optional<std::string> frame;  ///< of tf, in which the only waypoint is

  /// Where it is on its path at a time [s].
  Eigen::Isometry3d pose_at(double time) const;
};

/// A joint of nodes.
struct SimJoint {
  std::string place;
  Joints::Joint joint;
};

/// The contents of a scene file, checked as far as possible without making the scene.
struct SimDescription : SimSettings {
  Rods rods;  ///< as they lie in the file
  std::vector<SimFiber> fibers;
  std::vector<SimEffect> effects;                             ///< in the order of the scene
  std::optional<TimeTable<Eigen::Vector3d>> gravity_in_time;  ///< [m/s²]; none: it is constant
  SimCurvature natural_curvature;
  std::vector<SimHold> holds;
  std::vector<SimLoad> loads;
  std::vector<SimJoint> joints;
  std::vector<SimMovingObstacle> moving_obstacles;
  AllowedPairs allowed;             ///< fibres and objects that may touch
  bool separates_overlaps = false;  ///< moves fibres apart that begin inside of something

  /// Null if the scene does not name it.
  const SimEffect* find_effect(const std::string& name) const;
};

/// Simulates a scene from its beginning, and returns what each frame takes of one core [s], the
/// first one at least, until they have taken a budget [s] together.
using FrameTimer = std::function<std::vector<double>(const SimDescription& scene, double budget)>;

/// Reads a scene with the keys fibers, effects, environment (read_environment_scene()), frame_id,
/// time_step, substeps, iterations, residual, integrator, accuracy, real_time, initial_overlap,
/// max_strain.
/// docs/scene_keys.md says what they mean.
/// @param timer for scenes with `real_time`, whose segments and substeps are chosen by it; without
///              one, the processor time of this thread is measured, for two to eight seconds
/// @param links of robots, for obstacles that are some
/// @throws std::invalid_argument naming file, line, field and value, and what is allowed; and the
///         fibre where it is about one
SimDescription read_sim_scene(const YamlField& document, const MeshSource& meshes,
                              const FrameTimer& timer = {}, const LinkSource& links = no_links);

/// Holds nodes as told, in place of the holds that the scene has there.
/// @param list as that of the effect attachment, which the scene must name
/// @throws std::invalid_argument naming file, line, field and value, and what is allowed
void replace_holds(const YamlField& list, SimDescription& scene);

/// A parameter of an effect, one number or several, that may change between two steps.
struct SimParameter {
  std::string name;  ///< effect.option, as in the scene: gravity.acceleration
  std::vector<double> value;
};

/// The parameters of the effects that a scene names.
class SimParameters {
 public:
  /// @param apply changes the effect; throws std::invalid_argument for what is not allowed
  void add(const std::string& effect, const EffectOptions& options,
           std::function<void(const EffectOptions&)> apply);

  /// Changes all of these, or none.
  /// @throws std::invalid_argument naming the parameter, its value and what is allowed
  void set(const std::vector<SimParameter>& parameters);

  /// All parameters, by name.
  std::vector<SimParameter> all() const;

 private:
  struct Entry {
    EffectOptions options;
    std::function<void(const EffectOptions&)> apply;
  };

  void set_one(const SimParameter& parameter);

  std::map<std::string, Entry> effects_;
};

/// Placements by time [s], which rises.
using PlacementPath = std::vector<std::pair<double, Placement>>;

/// The placement at a time: between two of the path on a straight line, with directions that turn
/// at equal rates; before the first and after the last it is that one.
Placement placement_at(const PlacementPath& path, double time);

/// Poses by time [s], which rises.
using ObstaclePath = std::vector<std::pair<double, Eigen::Isometry3d>>;

/// The pose at a time: between two of the path on a straight line, turned at a constant rate;
/// before the first and after the last it is that one.
Eigen::Isometry3d pose_at(const ObstaclePath& path, double time);

/// A frame of tf that holds a fibre. The held node follows the frame's latest pose.
struct FollowedFrame {
  std::string frame;
  std::uint32_t hold;                   ///< as Attachment::add() calls it
  std::uint32_t rod;                    ///< that it holds
  std::uint32_t node;                   ///< of the rod, from its first one
  std::string what;                     ///< the held node and its place in the file, for warnings
  Placement in_frame;                   ///< of the held node, in the frame
  std::shared_ptr<PlacementPath> path;  ///< in the world, never empty; the hold follows it
};

/// A frame of tf that an obstacle follows.
struct FollowedObstacle {
  std::string frame;
  std::uint32_t obstacle;  ///< index among those that move
  std::string what;        ///< the obstacle and its place in the file, for warnings
  Eigen::Isometry3d in_frame;
  std::shared_ptr<ObstaclePath> path;  ///< in the world, never empty
};

/// An obstacle that came while a scene runs.
struct AddedObstacle {
  std::string name;
  std::shared_ptr<ObstaclePath> path;  ///< in the world, never empty
};

/// A scene of the simulation, ready to move.
struct SimScene : SimSettings {
  explicit SimScene(const SimSettings& settings) : SimSettings(settings) {}

  std::unique_ptr<Stepper> stepper;
  std::shared_ptr<Attachment> attachment;  ///< one of the stepper's effects; null without it
  std::vector<FollowedFrame> frames;       ///< whose placements are to be kept up to date

  std::vector<FollowedObstacle> obstacle_frames;  ///< alike

  /// Those among the obstacles that move that came later, behind the scene's own.
  std::vector<AddedObstacle> added_obstacles;

  /// By hold, as Attachment::add() calls it: of holds whose paths may change.
  std::map<std::uint32_t, std::shared_ptr<const PlacementPath>> paths;

  SimParameters parameters;  ///< of its effects

  /// The worst that steps of the last frame report: unbalanced islands and impacts of all together,
  /// `worst` where most is left, the most iterations and the largest energy gain.
  StepReport frame;

  std::string overlap_note;  ///< the overlaps that were separated at the beginning; empty without

  /// The motions of obstacles; null where none moves that fibres touch.
  const ObstacleMotions* motions() const { return stepper->moving_obstacles(); }

  /// All objects where they are now, those that move behind the others: as RodForces counts them.
  std::vector<EnvironmentObject> objects() const;

  /// The name of one of them.
  const std::string& object_name(std::uint32_t object) const;

  /// Whether steps may end before forces balance because the scene asks for fewer iterations than
  /// the default.
  bool asks_for_few_iterations() const {
    return options.max_iterations < StepperOptions().max_iterations;
  }

  /// Moves on by a frame.
  /// @throws std::runtime_error as Stepper::step()
  void advance();
};

/// Makes a scene. Any number of scenes may be made of one description.
/// @param threads most to use, 0 for as many as there are cores
/// @throws std::invalid_argument naming file and line, for effects that refuse their options, and
///         for fibres that begin inside of something, unless they are separated
SimScene make_sim_scene(const SimDescription& description, std::uint32_t threads);

/// A scene that goes on from where another one is, bit for bit, and shares nothing with it that
/// either changes. Its holds that follow frames of tf go on along what is known of these now.
/// @param description of both
/// @param threads     most to use, 0 for as many as there are cores
SimScene copy_sim_scene(const SimDescription& description, const SimScene& scene,
                        std::uint32_t threads);

}  // namespace fiber

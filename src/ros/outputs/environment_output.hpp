#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/ros/detection/detector.hpp"
#include "src/ros/detection/step_contacts.hpp"
#include "src/ros/environment/environment_inputs.hpp"
#include "src/ros/inputs/input_set.hpp"
#include "src/ros/outputs/contact_output.hpp"

namespace fiber_proximity_ros {

/// Contacts of the fibres with what is around them, on ~environment_contacts and
/// ~contact_events; not looked for while there is nothing around, or nobody asks.
class EnvironmentOutput {
 public:
  /// @param fibers      must outlive this
  /// @param on_message  see EnvironmentInputs
  /// @param on_newcomer see ContactOutput
  /// @throws std::invalid_argument for bad parameters (read_environment_options)
  EnvironmentOutput(const ros::NodeHandle& node, ros::NodeHandle private_node, InputSet& fibers,
                    std::function<void()> on_message, const Newcomer& on_newcomer);
  EnvironmentOutput(const EnvironmentOutput&) = delete;
  EnvironmentOutput& operator=(const EnvironmentOutput&) = delete;

  /// Takes over what has arrived about the environment.
  /// @returns true if that changed it
  bool update();

  /// Whether somebody listens, and there is or may be something around.
  bool has_listeners() const { return contacts_.has_listeners(); }
  bool is_used() const { return inputs_.is_used(); }

  /// Finds contacts and, if wanted, the closest pair. Once at most after each update().
  /// @param step since the answer before, if contacts in between are wanted and can be found; it
  ///        must live, unchanged, until publish()
  void detect(const fiber::QueryOptions& options, bool wants_minimum, const ContinuousStep* step);
  /// Publishes what detect() found, and what of it began or ended, if somebody listens.
  /// @param has_gradients whether derivatives are asked for
  void publish(const fiber::QueryOptions& options, const Knowledge& knowledge, bool has_gradients);

  /// An answer is given without looking around.
  void skip();

  const EnvironmentInputs& inputs() const { return inputs_; }

  // What the last detect() found, in which environment:
  const Detection& detection() const { return detection_; }
  const fiber::Environment& environment() const { return *environment_; }
  double update_time() const { return update_time_; }  ///< [s] to bring it up to date
  double motion_time() const { return motion_time_; }  ///< [s] to find contacts in between

 private:
  InputSet& fibers_;
  EnvironmentInputs inputs_;
  std::shared_ptr<const fiber::Environment> environment_;
  Detection detection_;
  fiber::MotionResult motion_result_;
  std::optional<KnownMotion> motion_;  // nothing if the answer is of its stamp alone
  bool is_tracked_ = false;            // the answer before was looked at
  double update_time_ = 0.0;
  double motion_time_ = 0.0;
  ContactOutput contacts_;
};

/// By index.
std::vector<std::string> object_names(const fiber::Environment& environment);

}  // namespace fiber_proximity_ros

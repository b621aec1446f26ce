#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <string>
#include <vector>

#include "src/ros/detection/knowledge.hpp"
#include "src/ros/environment/environment_inputs.hpp"
#include "src/ros/inputs/input_set.hpp"

namespace fiber_proximity_ros {

/// Where the fibres come from.
struct FiberInputOptions {
  std::vector<InputOptions> inputs;
  std::vector<Unknown> left_out;  ///< inputs that are configured and cannot be had
  InputTiming timing;

  /// All results are in this frame; empty: the frame of the first message.
  std::string fixed_frame;
};

/// All that messages have told the node: the fibres, what is around them, and what of both is
/// unknown.
struct ObservedScene {
  /// Tells what an update has changed.
  struct Changes {
    bool fibers;
    bool environment;
    bool knowledge;
  };

  /// @param answered   what the node asks about fibres; must outlive this
  /// @param on_message called for each message that arrives; it should see to it that update() is
  ///                   called soon
  /// @throws std::invalid_argument for bad parameters of the environment
  ///         (read_environment_options)
  ObservedScene(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                const FiberInputOptions& options, const fiber::QueryOptions& answered,
                const std::function<void()>& on_message);

  /// Takes over what has arrived.
  Changes update();

  /// True if update() should be called again soon: something waits for its transform or its mesh.
  bool is_waiting() const { return fibers.is_waiting() || environment.is_waiting(); }

  InputSet fibers;
  EnvironmentInputs environment;
  Knowledge knowledge;
  double environment_time = 0.0;  ///< [s] that the last update of the environment took
};

}  // namespace fiber_proximity_ros

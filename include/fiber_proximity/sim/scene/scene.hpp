#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/sim/effects/attachment.hpp"
#include "fiber_proximity/sim/scene/description.hpp"
#include "fiber_proximity/sim/scene/parameters.hpp"

namespace fiber {

/// Placements by time [s], which rises. In between straight lines; before and after, the first and
/// the last.
using PlacementPath = std::vector<std::pair<double, Placement>>;

/// A frame of tf that holds a fibre. What is held is where the frame was last, and turns with it.
struct FollowedFrame {
  std::string frame;
  std::uint32_t rod;                    ///< that it holds
  std::uint32_t node;                   ///< of the rod, from its first one
  std::string what;                     ///< what it holds and where that stands, for warnings
  Placement in_frame;                   ///< what it holds, in the frame
  std::shared_ptr<PlacementPath> path;  ///< in the world, never empty; the hold follows it
};

/// A scene of the simulation, ready to move.
struct SimScene : SimSettings {
  std::unique_ptr<Stepper> stepper;
  Attachment* attachment = nullptr;   ///< of the stepper; null without the effect
  std::vector<FollowedFrame> frames;  ///< whose placements are to be kept up to date
  SimParameters parameters;           ///< of its effects
  std::string overlap_note;           ///< what was moved before the beginning; empty if nothing was

  /// What the last step has left unbalanced, at StepReport::worst [N].
  double residual_force() const;

  /// Whether steps may end before forces balance, as the scene asks: it wants fewer iterations than
  /// are usual.
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

}  // namespace fiber

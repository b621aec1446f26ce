#pragma once

#include "fiber_proximity/CheckFibers.h"
#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/query/options.hpp"
#include "src/ros/detection/observed_scene.hpp"

namespace fiber_proximity_ros {

/// The scene that a request is about. Holds references: only for the call.
struct QueryTarget {
  const ObservedScene& scene;
  const fiber::FiberAssembly& fibers;
  const fiber::ProximityEngine*
      engine;  ///< updated to the fibres; null if they are not asked about
  const fiber::Environment& environment;
  const fiber::QueryOptions& defaults;  ///< what a request leaves open
  fiber::Deadline deadline;             ///< of the whole call, from its arrival

  /// Part of the time after which nothing more is examined: the rest is for the answer.
  static constexpr double examining_part = 0.8;

  bool is_time_up() const { return deadline.has_passed(examining_part); }

  /// [s] For the query that comes next, 0 if there is no deadline.
  double time_for_query() const { return examining_part * deadline.left(); }
};

/// Checks the candidates of a request or, with waypoint_offsets, their motions; fills in all of the
/// response but header, names and success. Candidates or motions that the deadline comes before are
/// not read, and nothing is known of them.
/// @throws std::invalid_argument naming the candidate, or the motion and its state, the value and
///         what is allowed
/// @throws TransformUnavailable naming the same and the frame
void answer(const fiber_proximity::CheckFibers::Request& request, const QueryTarget& target,
            fiber_proximity::CheckFibers::Response& response);

}  // namespace fiber_proximity_ros

#pragma once

#include <cstddef>

namespace fiber_proximity_ros {

/// When an input's messages and fibres expire, which stamps they may have, and whose belong
/// together.
struct InputTiming {
  /// [s] of wall time a message may wait for its transform; longer than tf takes to arrive
  double tf_timeout = 0.1;

  /// [s] of ROS time after which fibres that were not renewed are left out; several periods of any
  /// camera
  double input_timeout = 1.0;

  /// [s] a stamp may be ahead of the node's time; more than the clocks of one robot differ
  double max_stamp_ahead = 1.0;

  /// True: the fibres of all inputs change together, to those whose stamps belong together.
  bool synchronize = false;

  /// [s] most by which stamps that belong together differ; more than a period of a usual camera
  double synchronize_slop = 0.05;

  /// Messages of one input that wait, for their transforms or for those of the other inputs.
  /// Without synchronisation one keeps its turn, and the newest stands behind it.
  std::size_t queue_size() const { return synchronize ? 10 : 2; }
};

}  // namespace fiber_proximity_ros

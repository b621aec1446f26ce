#pragma once

#include <ros/time.h>
#include <visualization_msgs/Marker.h>

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/inputs/marker_fibers.hpp"

namespace fiber_proximity_ros {

/// The outcome of reading a message.
struct ReadResult {
  bool is_for_input = true;  ///< false: it holds nothing for this input

  /// Its fibres are others than before, or newer, even if its stamp is the same.
  bool is_news = false;

  std::string missing;               ///< what of the input is not known any more; empty: nothing
  std::vector<std::string> remarks;  ///< what the log is to be told of, once
};

/// The markers of one topic, which rviz would show: as there, one is in place of the one of its
/// namespace and id before, and stays until DELETE, DELETEALL or the end of its lifetime. One that
/// is not sent again within the timeout is left out, as messages of other types are, but not
/// forgotten: nobody has said that the fibre is gone.
class MarkerInput {
 public:
  using MarkerPtr = std::shared_ptr<const visualization_msgs::Marker>;

  explicit MarkerInput(MarkerInputOptions options) : options_(std::move(options)) {}

  /// [marker] More are not kept.
  static constexpr std::size_t max_markers = 100'000;

  /// Reads the fibres that there are with a message.
  /// @throws std::invalid_argument as to_chains(), and for unknown actions, negative lifetimes and
  ///         too many markers, naming the marker
  ReadResult read(const std::vector<MarkerPtr>& message, const ros::Time& now, FiberBuffer& fibers);

  /// Keeps what the last message has changed: without it the message has not been.
  void keep() { state_ = next_; }

 private:
  using Key = std::pair<std::string, std::int32_t>;  // namespace and id
  struct Kept {
    MarkerPtr marker;
    ros::Time arrival;
    ros::Time expiry;  // zero: never
  };
  using Kepts = std::map<Key, Kept>;

  struct State {
    Kepts kept;
    std_msgs::Header header;  // of the last fibres
    ros::Time last_read;
    std::size_t late_count = 0;
  };

  bool is_wanted(const visualization_msgs::Marker& marker) const;
  bool apply(const MarkerPtr& marker, const ros::Time& now, Kepts& kept) const;
  bool is_late(const Kept& kept, const ros::Time& now) const;

  MarkerInputOptions options_;
  State state_;
  State next_;  // once the message is kept
};

}  // namespace fiber_proximity_ros

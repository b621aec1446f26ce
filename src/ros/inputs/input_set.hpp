#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "src/ros/inputs/fixed_frame.hpp"
#include "src/ros/inputs/input.hpp"
#include "src/ros/inputs/merged_fibers.hpp"
#include "src/ros/inputs/synchronizer.hpp"
#include "src/ros/support/unknown.hpp"

namespace fiber_proximity_ros {

/// All inputs together: one assembly, in one frame, of the fibres of every input that is fresh, in
/// the order of the inputs. If they are synchronised, all fibres change together; inputs that have
/// fallen silent, or whose stamps never match, are left out then, as they would stop the others.
class InputSet {
 public:
  /// @param left_out   inputs that are configured and cannot be had
  /// @param answered   what the node asks about fibres; must outlive this
  /// @param on_message called for each message that arrives; it should see to it that update() is
  ///        called once the others that have arrived are in as well
  InputSet(ros::NodeHandle node, const std::vector<InputOptions>& inputs,
           std::vector<Unknown> left_out, const InputTiming& timing, const std::string& fixed_frame,
           const fiber::QueryOptions& answered, std::function<void()> on_message);

  /// Takes over what has arrived and leaves out what has expired.
  /// @returns true if that changed the fibres
  bool update();

  /// True if a message waits for its transform, or is tried: update() should be called again soon.
  bool is_waiting() const;

  /// True if at least one input is fresh, so that there is something to answer about.
  bool is_fresh() const;

  /// @throws std::invalid_argument saying so unless it is
  void require_fresh() const;

  /// Lists the parts of the inputs that are not known now: inputs without fresh fibres, and missing
  /// points of the others.
  std::vector<Unknown> unknown() const;

  /// An answer about these fibres has taken so long [s]: one of the inputs may cost too much.
  void doubt(double time);

  /// The topic from which the first fibres of most of these contacts come; empty without contacts.
  std::string topic_of_most(const std::vector<fiber::Contact>& contacts) const;

  /// The fibres of all fresh inputs, merged at the first call after a change. They stay as they are
  /// while somebody holds them.
  const std::shared_ptr<const FiberMessage>& message();
  const fiber::FiberAssembly& fibers() { return message()->fibers; }
  const std::vector<std::string>& names() const { return merged_.message()->names; }

  /// [m] By fibre of those that fibers() has returned last, how far its true points may be from the
  /// told ones at the time of the last update; empty where all are told to be exact.
  const std::vector<double>& uncertainties() const { return uncertainties_; }

  /// Fixed frame, and the newest stamp among the fibres; without any, the time of the last update.
  const std_msgs::Header& header() const { return header_; }

  const FixedFrame& frame() const { return frame_; }
  FixedFrame& frame() { return frame_; }
  const Inputs& inputs() const { return inputs_; }

  /// [s] Time spent on reading, transforming and merging since this was last asked.
  double take_work_time() { return std::exchange(work_time_, 0.0); }

 private:
  void receive(Input& input, const ReceivedMessage& message);
  void watch_time();
  bool accept_placed();
  void merge();
  void find_uncertainties();

  FixedFrame frame_;
  const fiber::QueryOptions& answered_;
  std::function<void()> on_message_;
  Inputs inputs_;
  std::vector<Unknown> left_out_;
  std::optional<Synchronizer> synchronizer_;  // if the inputs are synchronised
  ros::Time last_time_;
  bool can_be_uncertain_ = false;
  bool was_reset_ = false;
  bool merged_is_old_ = false;
  MergedFibers merged_;
  std::vector<double> uncertainties_;
  std_msgs::Header header_;
  double work_time_ = 0.0;
  // Last: their job and their callbacks use all of the above.
  Worker worker_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace fiber_proximity_ros

#pragma once

#include <ros/time.h>
#include <std_msgs/Header.h>

#include <Eigen/Geometry>
#include <functional>
#include <list>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

#include "fiber_proximity/InputStatistics.h"
#include "src/ros/environment/owed_changes.hpp"
#include "src/ros/inputs/fixed_frame.hpp"
#include "src/ros/inputs/message_log.hpp"
#include "src/ros/support/unknown.hpp"
#include "src/ros/support/worker.hpp"

namespace fiber_proximity_ros {

/// The objects that a change touches, and those among them that it removes before anything else.
class TouchedObjects {
 public:
  /// Notes the next step of the change.
  void add(const std::string& name);
  void append(const std::string& name);
  void move(const std::string& name);
  void remove(const std::string& name);
  void remove_all();

  const std::set<std::string>& names() const { return names_; }
  bool is_everything() const { return is_everything_; }

  /// Whether the object of a name is to be there after the change.
  bool wants(const std::string& name) const { return wanted_.count(name) > 0; }

  /// Whether nothing is left of what the object was before.
  bool makes_anew(const std::string& name) const { return made_anew_.count(name) > 0; }

  /// Whether its place is all that changes.
  bool only_moves(const std::string& name) const {
    return moved_.count(name) > 0 && !makes_anew(name) && appended_.count(name) == 0;
  }
  bool moves(const std::string& name) const { return moved_.count(name) > 0; }

  /// Whether it could undo another change.
  bool begins_with_removal() const { return removes_everything_first_ || !removed_first_.empty(); }

  /// Whether the order of the two changes matters.
  bool overlaps(const TouchedObjects& other) const;

  /// Whether nothing is left of this change once the later one has been made.
  bool is_undone_by(const TouchedObjects& later) const;

 private:
  std::set<std::string> names_;
  std::set<std::string> wanted_;         // of these names
  std::set<std::string> removed_first_;  // the same
  std::set<std::string> made_anew_;      // added or removed
  std::set<std::string> appended_;
  std::set<std::string> moved_;
  bool is_everything_ = false;
  bool removes_everything_first_ = false;
};

/// Something in the frame of a message.
struct FramedName {
  std::string name;  ///< what an error calls it
  std_msgs::Header header;
};

/// Pose of the thing's frame in the fixed frame, which is that of the first thing if there is none.
/// @throws TransformUnavailable naming the thing
Eigen::Isometry3d locate(const FramedName& thing, FixedFrame& frame);

/// The change that one message or request asks for. It is made as a whole, or not at all.
struct Change {
  using Poses = std::vector<Eigen::Isometry3d>;
  using Names = std::set<std::string>;

  /// Makes the change, or throws std::invalid_argument.
  /// @param poses     of the frames
  /// @param cancelled names of objects that may never have been added, because of this change
  using Apply = std::function<void(const Poses& poses, const Names& cancelled)>;

  enum class End {
    APPLIED,
    REFUSED,   ///< malformed, impossible, or no transform in time
    OVERTAKEN  ///< by a change that removes all it touches
  };

  TouchedObjects touched;
  std::vector<FramedName> frames;  ///< whose poses apply() needs; an empty one is the fixed frame
  Prepared<Apply> apply;
  double patience = 0.0;  ///< [s] of wall time that transforms may take, 0: they must be there

  /// Called once, at the end, with the reason if the change was refused.
  std::function<void(End, const std::string& reason)> on_end;

  std::string source;  ///< where it comes from, as /diagnostics names it
};

/// The making of a change that cannot be.
inline Prepared<Change::Apply> refusal(const std::string& problem) {
  return Prepared<Change::Apply>(
      [problem]() -> Change::Apply { throw std::invalid_argument(problem); });
}

/// Changes of the environment on their way. Each waits for three things: the transforms of its
/// frames, the preparation of its meshes, and its turn, which comes when no earlier change that
/// touches the same object is waiting. So the changes of one object keep their order, and those of
/// different objects do not wait for each other.
///
/// A change that waits for a transform, its own or one of a change before it, for longer than it
/// has patience is refused. One whose objects are all removed by a later change that is ready
/// itself is overtaken: it is never made.
class WaitingChanges {
 public:
  /// [change] More than these do not wait: what is beyond is refused.
  static constexpr std::size_t max_waiting = 1000;

  /// @param frame must outlive this
  explicit WaitingChanges(FixedFrame& frame) : frame_(frame) {}

  void receive(Change change);

  /// Makes the changes whose time has come.
  /// @returns true if there were any
  bool update();

  bool is_waiting() const { return !waiting_.empty(); }

  /// Objects of which a change waits: those that are not there yet, and those that are there and
  /// whose change has waited for longer than they may be late.
  /// @param is_there whether the world has an object of a name
  /// @param lateness [s]
  std::vector<Unknown> unknown(const std::function<bool(const std::string& name)>& is_there,
                               double lateness) const;

  /// Drops all, as this ends.
  void clear() { waiting_.clear(); }

 private:
  struct Waiting {
    explicit Waiting(Change received);

    void find_poses(FixedFrame& frame);
    bool is_placed() const { return poses.size() == change.frames.size(); }

    Change change;
    Change::Poses poses;                 // of the first frames
    std::string missing;                 // why the next one has none
    std::optional<Change::Apply> apply;  // once it is prepared
    ros::SteadyTime arrival = ros::SteadyTime::now();
    ros::Time since = ros::Time::now();  // the same
  };
  using Queue = std::list<Waiting>;

  /// The objects that changes which go on waiting touch, and why a change of one of them would wait
  /// for a transform; empty: it would not.
  struct Blocked {
    std::unordered_map<std::string, std::string> names;
    std::optional<std::string> everything;
    std::string any;  // why a change of everything would

    /// Null if the change need not wait for others.
    const std::string* find(const TouchedObjects& touched) const;
    void add(const TouchedObjects& touched, const std::string& missing);
  };

  /// @returns whether it has ended
  bool advance(Queue::iterator place, const std::string* blocked, bool& applied);
  bool make(Queue::iterator place, bool is_first);
  bool refuse(const Waiting& waiting, const std::string& reason) const;

  FixedFrame& frame_;
  Queue waiting_;
};

/// A topic whose messages change the environment: counts what becomes of them, and knows what it is
/// owed.
class ChangeTopic {
 public:
  /// @param required whether what is around the fibres is unknown until the first change
  /// @param scope    see OwedChanges::settle()
  /// @param owed     must outlive this
  ChangeTopic(const std::string& topic, const std::string& type, bool required, std::string scope,
              OwedChanges& owed)
      : topic_(topic),
        required_(required),
        scope_(std::move(scope)),
        owed_(owed),
        log_(topic, type) {}

  /// Counts a message.
  /// @returns the change with what counts its end, too; this must outlive it
  Change received(Change change);

  fiber_proximity::InputStatistics statistics(const ros::Time& now) const;

  /// Tells that no message has come yet on a topic that is required.
  std::optional<Unknown> unknown() const;

 private:
  std::string topic_;
  bool required_;
  std::string scope_;
  OwedChanges& owed_;
  MessageLog log_;
  ros::Time beginning_ = ros::Time::now();
  std::optional<ros::Time> last_applied_;
};

}  // namespace fiber_proximity_ros

#pragma once

#include <ros/time.h>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace fiber_proximity_ros {

/// Stamps that belong together, one per input; none for inputs that do not take part.
using StampSet = std::vector<std::optional<ros::Time>>;

/// Finds out which messages of several inputs belong together, by their stamps.
///
/// The sets are those of message_filters' policy ApproximateTime (its age penalty included), stamp
/// for stamp, which a test compares. That policy itself cannot be used: its number of inputs is
/// fixed at compile time and at most nine, and all must be heard for a set, while here inputs die
/// and come back. In short: every stamp is in one set at most, sets do not overlap in time, and of
/// the sets that contain the pivot, the latest of the oldest stamps, the one that spans least is
/// chosen, as soon as no later message can make a better one. Equal stamps are a set at once.
class StampMatcher {
 public:
  /// @param slop [s] most by which stamps of one set differ
  /// @param queue_size most stamps an input has waiting; of more the oldest is dropped
  StampMatcher(std::size_t inputs, double slop, std::size_t queue_size);

  /// Takes the newest stamp of an input, which takes part from now on. Stamps of one input do not
  /// decrease.
  void add(std::size_t input, const ros::Time& stamp);

  /// Forgets an input: sets are made without it until it is heard of again.
  /// @returns false if it was forgotten already
  bool leave_out(std::size_t input);

  /// Makes sets without the input whose newest stamp is farthest from this time, for the sake of
  /// the others, until one of its stamps is within the slop of theirs.
  void leave_out_farthest(const ros::Time& now);

  bool is_unmatched(std::size_t input) const { return queues_[input].is_unmatched; }

  /// True if there are stamps that wait for others to make a set.
  bool is_waiting() const;

  /// Forgets all of them.
  void reset();

  /// The sets found since this was last called, in the order they were found.
  std::vector<StampSet> take() { return std::exchange(found_, {}); }

 private:
  using Stamp = std::int64_t;  // [ns], as differences of ros::Time end at 68 years

  struct Queue {
    bool takes_part = false;
    bool is_unmatched = false;  // does not take part, but may again
    bool has_dropped = false;   // a better partner may have been lost, so this is no good pivot
    std::optional<Stamp> newest;
    std::deque<Stamp> stamps;
    std::size_t head = 0;  // those before have been tried already

    bool is_exhausted() const { return takes_part && head == stamps.size(); }
  };

  /// The set that is best so far: the first stamp of each queue.
  struct Candidate {
    std::size_t pivot = 0;
    Stamp pivot_stamp = 0;
    Stamp start = 0;
    Stamp end = 0;
  };

  struct Boundary {
    std::size_t input = 0;
    Stamp stamp = 0;
  };

  void readmit_unmatched();
  bool is_near(Stamp stamp) const;
  void search();
  bool is_optimal_whatever_comes() const;
  bool is_worth_no_more(Stamp end, Stamp start) const;
  bool has_all_heads() const;
  void begin_again();
  void make_candidate(const Boundary& start, const Boundary& end);
  void emit();
  template <class StampOf>
  std::pair<Boundary, Boundary> boundaries(const StampOf& stamp_of) const;

  Stamp slop_;
  std::size_t queue_size_;
  std::vector<Queue> queues_;
  std::optional<Candidate> candidate_;
  std::deque<Stamp> recent_;  // ends of the last sets
  std::vector<StampSet> found_;
};

}  // namespace fiber_proximity_ros

#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"

namespace fiber {

/// Chooses the skin for the next frames by what the last ones have cost, unless the user has
/// chosen.
///
/// A stretch is the frames from one fit of the tree to the next. A skin that lasts for n frames
/// costs a search for more pairs once in n frames, and the judging of all these in each of them.
/// How many pairs there are, and what they cost, is known from the last stretches; the n that costs
/// least is taken. Where none pays, a skin is thought of again after 1, 2, 4 … 256 frames.
///
/// Costs are counts times the time that one takes, not what a clock says: the same input gives the
/// same choices.
class SkinChoice {
 public:
  /// @param fixed [m] what the user has chosen; none: it chooses itself
  /// @throws std::invalid_argument if it is negative or not finite
  explicit SkinChoice(const std::optional<double>& fixed);

  /// [m] Pairs up to this far beyond the margin are kept, and tree and pairs serve until motion
  /// exceeds it.
  double skin() const { return skin_; }

  /// Whether pairs are kept. A fixed skin may be too short for that to pay.
  bool keeps_pairs() const { return pays_ && !are_too_many_; }

  /// Where more pairs are found, keeping them costs more than looking for those without a skin.
  std::uint64_t most_pairs() const { return most_pairs_; }

  /// Whether the next update is to know how far points have moved since this fit.
  bool asks_for_motion() const { return skin_ > 0.0 || (is_automatic_ && wait_ == 0); }

  /// Whether motion has become so slow that a shorter skin would cost less.
  bool lasts_too_long() const {
    return is_automatic_ && meant_frames_ > 0.0 && frames_ > 16.0 * meant_frames_;
  }

  /// Forgets: nothing is known of the fibres that come.
  void start();

  /// A frame ends with the update for the next one.
  void end_frame();

  /// The tree and what is kept serve for the next frame.
  void go_on() { pays_ = true; }

  /// Begins a stretch.
  /// @param moved [m] by each fibre since the last one began; none: that is not known
  void begin_stretch(const FiberAssembly& fibers, const std::vector<double>* moved);

  // What the frame has cost. Several threads may tell of queries at the same time.

  void note_fit(std::size_t segments) const { fitted_ += segments; }
  void note_motion(std::size_t points) const { measured_ += points; }
  void note_found(std::size_t pairs) const { found_ += pairs; }
  void note_too_many() const { are_too_many_ = true; }
  void note_query(const QueryCounts& counts) const {
    node_tests_ += counts.node_tests;
    judged_ += counts.primitive_tests;
  }

 private:
  /// [ns] of one thread.
  struct Work {
    double search = 0.0;  // fits, and tests of nodes
    double found = 0.0;   // pairs that searches come upon
    double judged = 0.0;  // pairs
    double motion = 0.0;

    double sum() const { return search + found + judged + motion; }
  };

  Work take_work();
  double cost_with(double frames) const;
  double best_frames() const;
  double motion_of_most(const FiberAssembly& fibers, const std::vector<double>& moved);
  void take(double frames, double motion);
  void do_without();

  const bool is_automatic_;
  double skin_;             // [m]
  bool pays_;               // pairs are kept
  std::uint32_t wait_ = 1;  // frames until motion is asked for, where no skin pays
  std::uint32_t next_wait_ = 2;
  std::uint32_t frames_ = 0;   // of this stretch
  double meant_frames_ = 0.0;  // that the skin is to last for; 0 without one
  std::uint64_t most_pairs_ = std::numeric_limits<std::uint64_t>::max();
  Work stretch_;                                          // of these frames
  Work without_;                                          // of the last frame without a skin
  std::vector<std::pair<double, std::uint32_t>> sample_;  // of fibres: motion [m] and points
  mutable std::atomic<bool> are_too_many_{false};
  mutable std::atomic<std::uint64_t> fitted_{0};
  mutable std::atomic<std::uint64_t> measured_{0};
  mutable std::atomic<std::uint64_t> node_tests_{0};
  mutable std::atomic<std::uint64_t> found_{0};
  mutable std::atomic<std::uint64_t> judged_{0};
};

}  // namespace fiber

#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/hierarchy/motion_bound.hpp"

namespace fiber {

/// The size of a search of the tree, counted or estimated.
struct SearchSize {
  double overlaps = 0.0;  ///< boxes of nodes and runs that are near others
  double pairs = 0.0;     ///< that it comes upon; at least, where that is more than was asked for
  double part = 0.0;      ///< of it that was searched to tell
};

/// Chooses the skin for the next frames, unless the user has chosen.
///
/// A stretch is the frames from one fit of the tree to the next. A skin that lasts for n frames
/// costs a search for more pairs once in n frames, and the judging of all these in each of them.
/// The last stretch tells how far points move in a frame; a part of the search tells how many pairs
/// a skin has. The n that costs least is taken, and kept for the next 1, 2, 4, 8 stretches as long
/// as they last for about as many frames; its skin goes by how far points move. Where none pays,
/// motion is looked at again after 1, 2, 4 … 256 frames, and another choice is made where it has
/// become slower, or after 256.
///
/// Costs are counts times the time that one takes, not what a clock says: the same input gives the
/// same choices.
class SkinChoice {
 public:
  /// The size of a search, estimated, for pairs up to so much [m] beyond the margin. It may end
  /// where there are more than so many.
  using Estimate = std::function<SearchSize(double skin, double max_pairs)>;

  /// @param fixed [m] what the user has chosen; none: it chooses itself
  /// @throws std::invalid_argument if it is negative or not finite
  explicit SkinChoice(const std::optional<double>& fixed);

  /// [m] Pairs up to this far beyond the margin are kept, and tree and pairs serve until motion
  /// exceeds it.
  double skin() const { return skin_; }

  /// Whether there can ever be one.
  bool may_be_one() const { return is_automatic_ || skin_ > 0.0; }

  /// Whether pairs are kept. A fixed skin may be too short for that to pay.
  bool keeps_pairs() const { return pays_ && !are_too_many_; }

  /// More than so many pairs are not kept: those estimated were far fewer.
  std::uint64_t max_pairs() const { return max_pairs_; }

  /// Whether the next update is to know how far points have moved since this fit.
  bool asks_for_motion() const { return skin_ > 0.0 || is_due_ || (is_automatic_ && wait_ == 0); }

  /// Whether the stretch is to end although the tree would serve: there were too many pairs, or
  /// motion has become so slow that a shorter skin would cost less.
  bool is_over() const {
    return are_too_many_ || (frames_meant_ > 0.0 && frames_ > 16.0 * frames_meant_);
  }

  /// Forgets: nothing is known of the fibres that come.
  void start();

  /// An update comes.
  void end_frame() { ++frames_; }

  /// The tree and what is kept serve for the next frame.
  void go_on() { pays_ = true; }

  /// Begins a stretch, with a fit.
  /// @param motion since the last one began; none: that is not known
  void begin_stretch(const FiberAssembly& fibers, const MotionBound* motion);

  /// Chooses, if that is due, before the first search of a stretch. Several threads may ask at the
  /// same time.
  void decide(const FiberAssembly& fibers, const Estimate& estimate);

  /// There are more than can be kept. Several threads may tell at the same time.
  void give_up() { are_too_many_ = true; }

 private:
  void choose(const FiberAssembly& fibers, const Estimate& estimate);
  double cost(double frames, const FiberAssembly& fibers, const SearchSize& search) const;
  double motion_of_most(const FiberAssembly& fibers, const std::vector<double>& moved);
  double skin_of(double frames) const;
  void last_for(double frames);
  void do_without();

  const bool is_automatic_;
  std::mutex mutex_;  // of decide()
  std::atomic<bool> are_too_many_{false};
  double skin_;  // [m]
  bool pays_;    // pairs are kept
  std::uint64_t max_pairs_ = std::numeric_limits<std::uint64_t>::max();
  bool is_due_ = false;
  double motion_ = 0.0;  // [m] a frame
  double motion_too_fast_ =
      std::numeric_limits<double>::infinity();  // for a skin to pay, [m] a frame
  std::uint32_t wait_ = 1;  // frames until motion is asked for, where no skin pays
  std::uint32_t next_wait_ = 2;
  std::uint32_t frames_ = 0;    // of this stretch
  double frames_meant_ = 0.0;   // that the skin is to last for; 0 without one
  double last_frames_ = 0.0;    // that the last skin was to last for
  double lasted_ = 1.0;         // the last skin, in units of that
  std::uint32_t kept_for_ = 0;  // stretches for which that is kept
  std::uint32_t next_kept_for_ = 1;
  std::vector<std::pair<double, std::uint32_t>> sample_;  // of fibres: motion [m] and points
};

}  // namespace fiber

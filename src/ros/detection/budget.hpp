#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace fiber_proximity_ros {

/// The stages of an answer, in this order.
enum class Stage {
  CONTACTS,            ///< of fibres with each other, and their closest pair
  MOTION,              ///< contacts in the time since the answer before
  OUTPUT,              ///< recognising and publishing these
  ENVIRONMENT,         ///< contacts and closest pair of fibres and objects
  ENVIRONMENT_MOTION,  ///< those since the answer before
  ENVIRONMENT_OUTPUT,
  PREDICTION,
  DRAWING,
  COUNT
};

/// The costs of a stage in the last answers [s], but for what a deadline can shorten.
class StageCosts {
 public:
  void add(double seconds);

  /// The stage was left out: it may have become cheaper since it was looked at.
  void forget_a_little();

  /// [s] What it costs in half of the answers; 0 as long as nothing is known.
  double usual() const { return quantile(2); }

  /// [s] By how much more it costs in one answer of sixteen.
  double spread() const { return quantile(16) - usual(); }

 private:
  /// [s] What one answer of so many exceeds.
  double quantile(std::size_t one_of) const;

  static constexpr std::size_t kept = 48;

  std::vector<double> costs_;  // [s]
  std::size_t next_ = 0;
  bool is_guess_ = false;  // forgotten a little since the last one
};

/// The time of an answer, which all its stages share. Answers aim at 95 % of the deadline. From
/// that goes what stages take that cannot be shortened, such as refitting trees and publishing, as
/// the last answers have it. The rest is for looking at pairs: the stages that do have equal shares
/// of it, and what one of them does not use goes to those after it. Stages that an answer can do
/// without are left out where there is no time even for what cannot be shortened of them.
///
/// Without a deadline it does nothing, and nothing is left out.
class Budget {
 public:
  /// Tells how long an answer has taken [s].
  using Clock = std::function<double()>;

  /// An answer begins.
  /// @param deadline [s] from its start; 0 for none
  /// @param clock    of this answer
  /// @param planned  the stages that are asked for
  void begin(double deadline, Clock clock, const std::vector<Stage>& planned);

  bool is_set() const { return deadline_ > 0.0; }

  /// Whether there is time for this stage.
  bool allows(Stage stage) const;

  /// A stage begins, and the one before ends.
  void enter(Stage stage);

  /// Looks at pairs in a stage that is entered.
  /// @param options with a deadline, which counts where the answer has none
  /// @param query   called with the options and the deadline of the stage
  template <class Options, class Query>
  void ask(Options options, const Query& query) {
    if (!is_set()) {
      query(options);
      return;
    }
    options.deadline = share();
    const double start = clock_();
    query(options);
    asked_ += std::min(clock_() - start, options.deadline);
  }

  /// The answer ends.
  void end() { enter(Stage::COUNT); }

 private:
  static constexpr auto stage_count = static_cast<std::size_t>(Stage::COUNT);
  static std::size_t index(Stage stage) { return static_cast<std::size_t>(stage); }

  double fixed() const { return clock_() - asked_; }
  double share() const;
  double reserve(const std::vector<Stage>& stages) const;

  std::array<StageCosts, stage_count> costs_;
  std::array<bool, stage_count> is_planned_{};
  double deadline_ = 0.0;  // [s]
  Clock clock_;
  Stage current_ = Stage::COUNT;
  double entered_ = 0.0;  // [s] of fixed() when the current stage began
  double asked_ = 0.0;    // [s] of looking at pairs up to now
};

}  // namespace fiber_proximity_ros

#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "fiber_proximity/query/engine.hpp"

namespace fiber {

/// Whose answer about a pair holds, as far as its error permits.
enum class Verdict {
  BOTH,    ///< they differ by less than what they are rounded by
  OURS,    ///< ours alone
  FCL,     ///< FCL's alone
  NEITHER  ///< none
};

/// both, ours, fcl or neither
const char* name_of(Verdict verdict);

/// The result of one side for a pair, with the bounds that its error permits for the truth.
struct PairClaim {
  double gap = 0.0;    ///< [m] of the surfaces
  double lower = 0.0;  ///< [m] the true gap should be at least this
  double upper = 0.0;  ///< [m] and at most this
};

/// A pair of which one side alone says that it is within the margin, or whose distances differ by
/// more than both errors permit.
struct Disagreement {
  SegmentId a;
  SegmentId b;
  std::optional<PairClaim> ours;  ///< none: no contact
  std::optional<PairClaim> fcl;   ///< none: no contact
  bool fcl_has_answer = true;     ///< false: not even that; FCL threw, or its distance is no number
  double gap = 0.0;               ///< [m] from the exact distance, rounded three times
  bool is_contact = false;        ///< whether the exact gap is at most the margin
  Verdict verdict = Verdict::BOTH;
};

/// How FCL is used.
enum class FclStyle {
  USER,  ///< its capsules, its boxes, its distances: as it is mostly used
  BEST   ///< its tree over our boxes and before our narrow phase
};

/// user or best
const char* name_of(FclStyle style);

/// FCL beside our engine, on the same fibres.
struct StyleComparison {
  FclStyle style = FclStyle::USER;
  double update_time = 0.0;      ///< [s] to refit FCL's tree, or to build it for other fibres
  double detect_time = 0.0;      ///< [s] to find the contacts
  std::uint64_t pair_tests = 0;  ///< pairs of segments whose distance was computed
  std::uint64_t contacts = 0;
  std::uint64_t only_ours = 0;  ///< pairs within the margin by our answer alone
  std::uint64_t only_fcl = 0;   ///< pairs within the margin by FCL's answer alone
  std::uint64_t in_both = 0;
  std::uint64_t no_answer = 0;  ///< pairs FCL threw for, or computed no number for

  /// [m] Of the distances of pairs in both, and which pair has it; 0 without any.
  double largest_difference = 0.0;
  SegmentId largest_a;
  SegmentId largest_b;

  std::vector<Disagreement> disagreements;  ///< sorted by segments

  /// Number of disagreements with this verdict.
  std::uint64_t count(Verdict verdict) const;
};

/// Our engine and FCL in both styles.
struct Comparison {
  double margin = 0.0;           ///< [m]
  double detect_time = 0.0;      ///< [s] of our engine
  std::uint64_t pair_tests = 0;  ///< of our engine
  std::uint64_t contacts = 0;    ///< of our engine
  std::array<StyleComparison, 2> styles;

  /// Number of disagreements with this verdict, in both styles.
  std::uint64_t count(Verdict verdict) const;

  /// Whether our engine's answer holds wherever FCL's differs.
  bool ours_is_right() const;
};

/// Runs FCL beside an engine, frame by frame: its trees are kept, and refitted to fibres that only
/// moved. For one thread at a time.
class FclComparer {
 public:
  FclComparer();
  ~FclComparer();

  /// All pairs within the margin by the engine and by FCL in both styles, the user's first.
  /// @param engine updated to these fibres
  /// @param options type, tolerances and deadline do not count: all pairs are asked for
  /// @throws std::invalid_argument for options that do not validate or an infinite margin
  Comparison compare(const FiberAssembly& fibers, const ProximityEngine& engine,
                     const QueryOptions& options);

 private:
  class Trees;

  std::unique_ptr<Trees> trees_;
};

}  // namespace fiber

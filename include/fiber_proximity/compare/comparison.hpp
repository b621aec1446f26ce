#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fiber_proximity/compare/disagreement.hpp"

namespace fiber {

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

/// A contact by the first points of its segments.
struct PairAnswered {
  PointPair pair{};        ///< the smaller one first
  bool has_answer = true;  ///< false: nothing is known of the pair
  PairClaim claim;
};

/// Compares two lists of contacts.
/// @param ours, fcl sorted by their pairs, each pair once
/// @param comparison its counts, differences and disagreements are set; the others are left alone
void compare(const PairOracle& oracle, const std::vector<PairAnswered>& ours,
             const std::vector<PairAnswered>& fcl, StyleComparison& comparison);

}  // namespace fiber

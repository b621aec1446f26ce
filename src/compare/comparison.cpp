#include "fiber_proximity/compare/comparison.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "src/query/contact_evaluator.hpp"

namespace fiber {
namespace {

/// What the claim's error may add up to [m].
double error_of(const PairClaim& claim) {
  return std::max(claim.upper - claim.gap, claim.gap - claim.lower);
}

/// Takes two sorted lists in turns.
class Merge {
 public:
  Merge(const PairOracle& oracle, StyleComparison& comparison)
      : oracle_(oracle), comparison_(comparison) {}

  void only_ours(const PairAnswered& ours) {
    ++comparison_.only_ours;
    report(ours.pair, ours.claim, std::nullopt, true);
  }

  void only_fcl(const PairAnswered& fcl) {
    if (!fcl.has_answer) {
      ++comparison_.no_answer;  // ours knows it for no contact
      return;
    }
    ++comparison_.only_fcl;
    report(fcl.pair, std::nullopt, fcl.claim, true);
  }

  void both(const PairAnswered& ours, const PairAnswered& fcl) {
    if (!fcl.has_answer) {
      ++comparison_.no_answer;
      ++comparison_.only_ours;
      report(ours.pair, ours.claim, std::nullopt, false);
      return;
    }
    ++comparison_.in_both;
    const double difference = std::abs(ours.claim.gap - fcl.claim.gap);
    if (difference > comparison_.largest_difference) {
      comparison_.largest_difference = difference;
      comparison_.largest_a = oracle_.segment(ours.pair.a);
      comparison_.largest_b = oracle_.segment(ours.pair.b);
    }
    if (!(difference <= error_of(ours.claim) + error_of(fcl.claim))) {
      report(ours.pair, ours.claim, fcl.claim, true);
    }
  }

 private:
  void report(PointPair pair, const std::optional<PairClaim>& ours,
              const std::optional<PairClaim>& fcl, bool fcl_has_answer) {
    comparison_.disagreements.push_back(oracle_.judge(pair, ours, fcl, fcl_has_answer));
  }

  const PairOracle& oracle_;
  StyleComparison& comparison_;
};

}  // namespace

const char* name_of(FclStyle style) { return style == FclStyle::USER ? "user" : "best"; }

std::uint64_t StyleComparison::count(Verdict verdict) const {
  return static_cast<std::uint64_t>(
      std::count_if(disagreements.begin(), disagreements.end(),
                    [=](const Disagreement& each) { return each.verdict == verdict; }));
}

std::uint64_t Comparison::count(Verdict verdict) const {
  std::uint64_t count = 0;
  for (const StyleComparison& style : styles) {
    count += style.count(verdict);
  }
  return count;
}

bool Comparison::ours_is_right() const {
  return count(Verdict::FCL) + count(Verdict::NEITHER) == 0;
}

void compare(const PairOracle& oracle, const std::vector<PairAnswered>& ours,
             const std::vector<PairAnswered>& fcl, StyleComparison& comparison) {
  Merge merge(oracle, comparison);
  auto our = ours.begin();
  auto theirs = fcl.begin();
  while (our != ours.end() || theirs != fcl.end()) {
    if (theirs == fcl.end() || (our != ours.end() && key_of(our->pair) < key_of(theirs->pair))) {
      merge.only_ours(*our++);
    } else if (our == ours.end() || key_of(theirs->pair) < key_of(our->pair)) {
      merge.only_fcl(*theirs++);
    } else {
      merge.both(*our++, *theirs++);
    }
  }
}

}  // namespace fiber

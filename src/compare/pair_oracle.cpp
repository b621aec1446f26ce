#include "src/compare/pair_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "src/query/contact_evaluator.hpp"

namespace fiber {
namespace {

double magnitude(const Capsule& capsule) {
  return std::max(capsule.p0.cwiseAbs().maxCoeff(), capsule.p1.cwiseAbs().maxCoeff());
}

/// The bound of the claim's error [m].
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

double fcl_error(const Capsule& a, const Capsule& b) {
  return 0x1p-48 * (std::max(magnitude(a), magnitude(b)) + a.radius + b.radius);
}

PairOracle::PairOracle(const FiberAssembly& fibers, const QueryOptions& options)
    : fibers_(fibers), options_(options), test_(fibers, options) {}

Disagreement PairOracle::judge(PointPair pair, const std::optional<PairClaim>& ours,
                               const std::optional<PairClaim>& fcl, bool fcl_has_answer) const {
  const Capsule a = fibers_.capsule(pair.a);
  const Capsule b = fibers_.capsule(pair.b);
  Disagreement found;
  found.a = segment(pair.a);
  found.b = segment(pair.b);
  found.ours = ours;
  found.fcl = fcl;
  found.fcl_has_answer = fcl_has_answer;
  found.gap = exact_segment_distance(a.p0, a.p1, b.p0, b.p1).distance - (a.radius + b.radius);
  found.is_contact = gap_is_at_most(pair, options_.margin);
  const bool ours_right = ours_is_right(pair, found);
  const bool fcl_right = fcl_is_right(pair, found);
  if (ours_right) {
    found.verdict = fcl_right ? Verdict::BOTH : Verdict::OURS;
  } else {
    found.verdict = fcl_right ? Verdict::FCL : Verdict::NEITHER;
  }
  return found;
}

/// The kernel exact decides without error; robust goes by the distance that it computes.
bool PairOracle::ours_is_right(PointPair pair, const Disagreement& found) const {
  const bool decides_exactly = options_.kernel != Kernel::ROBUST;
  if (found.ours) {
    return gap_is_within(pair, *found.ours) && (found.is_contact || !decides_exactly);
  }
  return !found.is_contact ||
         (!decides_exactly && !test_.is_within_margin(pair, test_.distance(pair)));
}

bool PairOracle::fcl_is_right(PointPair pair, const Disagreement& found) const {
  if (!found.fcl_has_answer) {
    return false;
  }
  if (found.fcl) {
    return gap_is_within(pair, *found.fcl);
  }
  const double error = fcl_error(fibers_.capsule(pair.a), fibers_.capsule(pair.b));
  return !found.is_contact || gap_is_at_least(pair, options_.margin - error);
}

bool PairOracle::gap_is_at_most(PointPair pair, double limit) const {
  const Capsule a = fibers_.capsule(pair.a);
  const Capsule b = fibers_.capsule(pair.b);
  return exact_gap_at_most(a.p0, a.p1, b.p0, b.p1, {a.radius, b.radius, limit});
}

bool PairOracle::gap_is_at_least(PointPair pair, double limit) const {
  constexpr double lowest = -std::numeric_limits<double>::infinity();
  return limit == lowest || !gap_is_at_most(pair, std::nextafter(limit, lowest));
}

bool PairOracle::gap_is_within(PointPair pair, const PairClaim& claim) const {
  return claim.lower <= claim.gap && claim.gap <= claim.upper &&
         gap_is_at_least(pair, claim.lower) && gap_is_at_most(pair, claim.upper);
}

void compare(const PairOracle& oracle, const std::vector<PairAnswered>& ours,
             const std::vector<PairAnswered>& fcl, StyleComparison& comparison) {
  Merge merge(oracle, comparison);
  auto our = ours.begin();
  auto theirs = fcl.begin();
  while (our != ours.end() || theirs != fcl.end()) {
    if (theirs == fcl.end() ||
        (our != ours.end() && pair_key(our->pair) < pair_key(theirs->pair))) {
      merge.only_ours(*our++);
    } else if (our == ours.end() || pair_key(theirs->pair) < pair_key(our->pair)) {
      merge.only_fcl(*theirs++);
    } else {
      merge.both(*our++, *theirs++);
    }
  }
}

}  // namespace fiber

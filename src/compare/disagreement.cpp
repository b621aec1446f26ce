#include "fiber_proximity/compare/disagreement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fiber_proximity/geometry/exact_distance.hpp"

namespace fiber {
namespace {

double magnitude(const Capsule& capsule) {
  return std::max(capsule.p0.cwiseAbs().maxCoeff(), capsule.p1.cwiseAbs().maxCoeff());
}

}  // namespace

const char* name_of(Verdict verdict) {
  constexpr const char* names[] = {"both", "ours", "fcl", "neither"};
  return names[static_cast<int>(verdict)];
}

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

}  // namespace fiber

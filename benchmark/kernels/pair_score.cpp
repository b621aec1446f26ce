#include "benchmark/kernels/pair_score.hpp"

#include <algorithm>
#include <cmath>

#include "fiber_proximity/geometry/segment_distance.hpp"

namespace fiber {
namespace {

constexpr double least = std::numeric_limits<double>::denorm_min();  // [m]

double extent(const HardPair& pair) {
  const auto high = pair.p0.cwiseMax(pair.p1).cwiseMax(pair.q0).cwiseMax(pair.q1);
  const auto low = pair.p0.cwiseMin(pair.p1).cwiseMin(pair.q0).cwiseMin(pair.q1);
  return (high - low).maxCoeff();
}

bool is_at_most(const HardPair& pair, const ContactLimit& limit) {
  return exact_gap_at_most(pair.p0, pair.p1, pair.q0, pair.q1, limit);
}

/// Exactly, but that a truth less than the least double below the lower bound passes.
bool is_within(const HardPair& pair, double lower, double upper) {
  const bool above = lower <= 0.0 || !is_at_most(pair, {lower, 0.0, -least});
  return above && (std::isinf(upper) || is_at_most(pair, {upper, 0.0, 0.0}));
}

}  // namespace

std::vector<Guarded<PairAnswer>> guarded_answers(PairKernel& kernel, std::size_t count) {
  return guarded_answers<PairAnswer>(
      count, [&](std::size_t index) { return kernel.answer(index); },
      [](const PairAnswer& answer) { return std::isfinite(answer.distance); });
}

PairTruth::PairTruth(const HardPair& pair)
    : distance(exact_segment_distance(pair.p0, pair.p1, pair.q0, pair.q1).distance),
      unit(std::max(std::numeric_limits<double>::epsilon() * extent(pair), least)),
      contact(is_at_most(pair, {pair.radius_a, pair.radius_b, 0.0})) {}

void PairScore::add(const HardPair& pair, const PairTruth& truth,
                    const Guarded<PairAnswer>& guarded) {
  not_finite_ += guarded.outcome == Outcome::NOT_FINITE ? 1 : 0;
  no_answer_ += guarded.outcome == Outcome::NO_ANSWER ? 1 : 0;
  ended_ += guarded.outcome == Outcome::ENDED ? 1 : 0;
  if (guarded.outcome != Outcome::ANSWERED) {
    return;
  }
  ++answered_;
  const PairAnswer& answer = guarded.answer;
  const double error = std::abs(answer.distance - truth.distance);
  error_ = std::max(error_, error);
  error_units_ = std::max(error_units_, error / truth.unit);
  if (truth.distance > 0.0) {
    relative_error_ = std::max(relative_error_, error / truth.distance);
  }
  const bool plain = answer.distance <= pair.radius_a + pair.radius_b;
  false_contacts_ += answer.contact && !truth.contact ? 1 : 0;
  missed_contacts_ += !answer.contact && truth.contact ? 1 : 0;
  plain_false_contacts_ += plain && !truth.contact ? 1 : 0;
  plain_missed_contacts_ += !plain && truth.contact ? 1 : 0;
  outside_bounds_ += is_within(pair, answer.lower, answer.upper) ? 0 : 1;
}

}  // namespace fiber

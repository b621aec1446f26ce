#include "src/sim/resolution.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/sim/require.hpp"

namespace fiber {
namespace {

/// The part of the accuracy that segments may use up, and that steps may.
constexpr double half = 0.5;

void require_accuracy(double accuracy) {
  require(accuracy > 0.0 && accuracy <= 0.5, "accuracy", accuracy, "", "above 0 and at most 0.5");
}

std::uint32_t whole(double number) {
  constexpr double max = std::numeric_limits<std::uint32_t>::max();
  // A whole number with rounding errors does not round up to the next one.
  return static_cast<std::uint32_t>(std::clamp(std::ceil(number - 1e-9 * number), 1.0, max));
}

}  // namespace

std::uint32_t segments_for(double accuracy, double turning, double limpness) {
  require_accuracy(accuracy);
  require_not_negative("turning", turning, " rad");
  require(limpness >= 0.0, "limpness", limpness, "", "at least 0");
  const double swing = std::min(ResolutionTable::swing * limpness, ResolutionTable::max_swing);
  return whole(std::max(std::sqrt(std::max(ResolutionTable::bending, swing / half) / accuracy),
                        turning * std::sqrt(ResolutionTable::turning / accuracy)));
}

double limpness(const RodSection& section, double length, double gravity) {
  const double weight = section.mass_per_length * gravity;
  return weight > 0.0 ? length * std::cbrt(weight / section.bending_stiffness) : 0.0;
}

std::uint32_t substeps_for(double accuracy, Integrator integrator, double frame, double period) {
  require_accuracy(accuracy);
  require_positive("frame", frame, " s");
  require(period > 0.0, "period", period, " s", "positive");
  const double step = integrator == Integrator::IMPLICIT_EULER
                          ? half * accuracy / ResolutionTable::euler * period
                          : std::sqrt(half * accuracy / ResolutionTable::bdf2) * period;
  return whole(frame / step);
}

double max_contact_step(double radius, double gravity) {
  return std::sqrt(ResolutionTable::contact_travel * radius / gravity);
}

double swing_period(const RodSection& section, double length, double gravity) {
  constexpr double chain = 1.2024;       // half the first zero of the Bessel function J0
  constexpr double cantilever = 3.5160;  // the first root of 1 + cos k cosh k, squared
  const double by_weight = chain * chain * gravity / length;
  const double by_stiffness = cantilever * cantilever * section.bending_stiffness /
                              (section.mass_per_length * std::pow(length, 4));
  return 2.0 * M_PI / std::sqrt(by_weight + by_stiffness);
}

}  // namespace fiber

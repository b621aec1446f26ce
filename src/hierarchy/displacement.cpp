#include "src/hierarchy/displacement.hpp"

namespace fiber {

Approach::Approach(double way, double rate, double thickness) {
  if (!(rate < 1.0)) {
    offset_ = std::numeric_limits<double>::infinity();
    return;
  }
  // Axes that are thickness + gap apart were at most (thickness + gap + way) / (1 − rate).
  constexpr double slack = 1.0 + 8.0 * std::numeric_limits<double>::epsilon();
  factor_ = slack / (1.0 - rate);
  offset_ = slack * slack * factor_ * (way + rate * thickness) +
            8.0 * std::numeric_limits<double>::epsilon() * thickness;
}

}  // namespace fiber

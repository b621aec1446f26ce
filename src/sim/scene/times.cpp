#include "src/sim/scene/times.hpp"

#include <cmath>

namespace fiber {

double read_time(const YamlField& time, std::optional<double> before, const std::string& what) {
  const double value = time.number();
  if (!std::isfinite(value)) {
    time.refuse("finite");
  }
  if (before && !(value > *before)) {
    time.refuse("later than the time before, " + std::to_string(*before) + " s");
  }
  if (!before && value != 0.0) {
    time.refuse("0, where the " + what + " begins");
  }
  return value;
}

double read_period(const YamlField& period, double last, const std::string& what) {
  const double length = period.number();
  if (!(std::isfinite(length) && length > last)) {
    period.refuse("longer than the " + what + ", " + std::to_string(last) +
                  " s: it leads back to its beginning");
  }
  return length;
}

}  // namespace fiber

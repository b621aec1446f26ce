#include "src/bounds/bounding_volume.hpp"

#include <cmath>
#include <limits>

namespace fiber {

float round_up(double margin) {
  if (margin > std::numeric_limits<float>::max()) {
    return std::numeric_limits<float>::infinity();
  }
  const auto nearest = static_cast<float>(margin);
  return static_cast<double>(nearest) < margin
             ? std::nextafter(nearest, std::numeric_limits<float>::infinity())
             : nearest;
}

}  // namespace fiber

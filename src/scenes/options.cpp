#include "fiber_proximity/scenes/options.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "src/io/number.hpp"

namespace fiber {

std::uint32_t scaled_fiber_count(const SceneOptions& options, std::uint32_t full_count,
                                 std::uint32_t points_per_fiber, std::uint32_t most_fibers) {
  constexpr double most_points = 0x1p31 - 1.0;
  const double limit = std::min<double>(std::floor(most_points / points_per_fiber), most_fibers);
  const double fibers = std::floor(options.scale * full_count + 0.5);
  if (!(options.scale > 0.0) || fibers > limit) {
    std::string message = "scale is ";
    append_number(message, options.scale);
    message += ", it must be above 0 and at most ";
    append_number(message, std::floor(100.0 * limit / full_count) / 100.0);
    throw std::invalid_argument(message);
  }
  return fibers < 1.0 ? 1U : static_cast<std::uint32_t>(fibers);
}

}  // namespace fiber

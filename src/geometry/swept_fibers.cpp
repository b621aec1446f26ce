#include "src/geometry/swept_fibers.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "src/geometry/norm.hpp"

namespace fiber {

void require_same_topology(const FiberAssembly& before, const FiberAssembly& after) {
  if (before.offsets() != after.offsets()) {
    std::ostringstream message;
    message << "the fibres change their topology: " << before.fiber_count() << " of "
            << before.point_count() << " points before, " << after.fiber_count() << " of "
            << after.point_count()
            << " after; a motion needs the same fibres with the same numbers of points";
    throw std::invalid_argument(message.str());
  }
  if (!before.has_topology_of(after)) {
    throw std::invalid_argument(
        "the fibres change their topology: others are closed or joined after than before; a motion "
        "needs the same");
  }
}

Eigen::Vector3d drift_of(const FiberAssembly& before, const FiberAssembly& after) {
  constexpr std::size_t sample = 512;
  const std::size_t step = before.point_count() / sample + 1;
  const std::size_t count = (before.point_count() + step - 1) / step;
  // Each adds its part: the sum of all could leave the range of double.
  const double part = 1.0 / static_cast<double>(std::max<std::size_t>(count, 1));
  Eigen::Vector3d drift = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < before.point_count(); i += step) {
    drift += part * (after.points()[i] - before.points()[i]);
  }
  return drift;
}

void SweptFibers::update(const FiberAssembly& before, const FiberAssembly& after) {
  require_same_topology(before, after);
  update(before, after, drift_of(before, after));
}

void SweptFibers::update(const FiberAssembly& before, const FiberAssembly& after,
                         const Eigen::Vector3d& drift) {
  require_same_topology(before, after);
  drift_ = drift;
  const std::size_t count = before.point_count();
  points_.resize(count);
  half_ways_.resize(count);
  segment_radii_.assign(count, 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d& from = before.points()[i];
    const Eigen::Vector3d& to = after.points()[i];
    points_[i] = 0.5 * from + 0.5 * to;
    // Sums and differences here and in what is swept err by less than 2⁻⁵¹ of these together.
    const double magnitude = std::max(from.cwiseAbs().maxCoeff(), to.cwiseAbs().maxCoeff()) +
                             drift.cwiseAbs().maxCoeff();
    half_ways_[i] = 0.5 * norm_of((to - from) - drift) * (1.0 + 0x1p-50) + 0x1p-48 * magnitude;
  }
  for (std::size_t fiber = 0; fiber < before.fiber_count(); ++fiber) {
    for (std::uint32_t i = before.offsets()[fiber]; i + 1 < before.offsets()[fiber + 1]; ++i) {
      const double radius = std::max(before.segment_radius(i), after.segment_radius(i));
      segment_radii_[i] = (radius + std::max(half_ways_[i], half_ways_[i + 1])) * (1.0 + 0x1p-50);
      if (!FiberAssembly::is_valid_radius(segment_radii_[i])) {
        std::ostringstream message;
        message << "fibre " << fiber << ", segment " << i - before.offsets()[fiber]
                << ": moves so far that with its radius it sweeps " << segment_radii_[i]
                << " m to each side; at most " << FiberAssembly::max_coordinate << " m are allowed";
        throw std::invalid_argument(message.str());
      }
    }
  }
  fibers_.assign_segments(points_, before.offsets(), segment_radii_);
}

}  // namespace fiber

#include "fiber_proximity/sim/rods.hpp"

#include <cmath>
#include <stdexcept>
#include <string>

namespace fiber {
namespace {

/// [m] Beyond this, squares of squares of lengths are no longer finite.
constexpr double largest_coordinate = 1e60;

[[noreturn]] void refuse(std::uint32_t rod, const std::string& problem) {
  throw std::invalid_argument("rod " + std::to_string(rod) + ": " + problem);
}

void validate(std::uint32_t rod, const std::vector<Eigen::Vector3d>& points, double radius) {
  if (points.size() < 2) {
    refuse(rod, "has " + std::to_string(points.size()) + " point(s), it must have at least 2");
  }
  if (!(std::isfinite(radius) && radius > 0.0)) {
    refuse(rod, "radius is " + std::to_string(radius) + ", it must be positive and finite");
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(points[i].cwiseAbs().maxCoeff() <= largest_coordinate) || points[i].hasNaN()) {
      refuse(rod, "point " + std::to_string(i) + " must be finite and at most 1e60 m");
    }
    if (i > 0 && !((points[i] - points[i - 1]).norm() > 0.0)) {
      refuse(rod, "edge " + std::to_string(i - 1) + " has no length: its points are the same");
    }
  }
}

}  // namespace

void Rods::add(const std::vector<Eigen::Vector3d>& points, double radius,
               const RodSection& section) {
  validate(count(), points, radius);
  validate(section);
  const std::size_t begin = positions.size();
  offsets.push_back(static_cast<std::uint32_t>(begin + points.size()));
  radii.push_back(radius);
  sections.push_back(section);
  positions.insert(positions.end(), points.begin(), points.end());
  velocities.resize(positions.size(), Eigen::Vector3d::Zero());
  masses.resize(positions.size(), 0.0);
  rest_lengths.resize(positions.size(), 0.0);
  for (std::size_t i = begin; i + 1 < positions.size(); ++i) {
    rest_lengths[i] = (positions[i + 1] - positions[i]).norm();
    const double half_mass = 0.5 * section.mass_per_length * rest_lengths[i];
    masses[i] += half_mass;
    masses[i + 1] += half_mass;
  }
}

}  // namespace fiber

#include "fiber_proximity/sim/rods.hpp"

#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

#include "src/sim/require.hpp"
#include "src/text/join.hpp"
#include "src/text/quote.hpp"

namespace fiber {

namespace {

const std::map<std::string, RodMaterial>& presets() {
  static const std::map<std::string, RodMaterial> presets{
      // Keratin.
      {"hair", {3.9e9, 1.5e9, 1320.0, 1.0}},
      // Stranded copper in PVC, 3 x 1.5 mm² in 8 mm: the strands carry the tension.
      {"power_cable", {1.0e10, 4.0e7, 2200.0, 0.01}},
      // Braided polyamide.
      {"rope", {9.0e8, 2.0e6, 800.0, 0.001}},
      // Shore A 50, taken as solid.
      {"silicone_tube", {2.5e6, 8.4e5, 1150.0, 1.0}},
  };
  return presets;
}

}  // namespace

RodMaterial material_preset(const std::string& name) {
  const auto found = presets().find(name);
  if (found != presets().end()) {
    return found->second;
  }
  throw std::invalid_argument("there is no material " + quote(name) +
                              ", known are: " + join(material_names()));
}

std::vector<std::string> material_names() {
  std::vector<std::string> names;
  for (const auto& [name, material] : presets()) {
    names.push_back(name);
  }
  return names;
}

RodSection solid_round_section(const RodMaterial& material, double radius) {
  require_positive("youngs_modulus", material.youngs_modulus);
  require_positive("shear_modulus", material.shear_modulus);
  require_positive("density", material.density);
  require(material.bending_share > 0.0 && material.bending_share <= 1.0, "bending_share",
          material.bending_share, "", "above 0 and at most 1");
  require(material.bending_ratio >= 1.0 && std::isfinite(material.bending_ratio), "bending_ratio",
          material.bending_ratio, "", "at least 1 and finite");
  require_positive("radius", radius);
  const double area = M_PI * radius * radius;
  const double second_moment = area * radius * radius / 4.0;
  const double polar_moment = 2.0 * second_moment;
  return {material.youngs_modulus * area,
          material.bending_share * material.youngs_modulus * second_moment,
          material.shear_modulus * polar_moment,
          material.density * area,
          material.density * polar_moment,
          material.bending_ratio};
}

namespace {

/// All values must be finite; stretching stiffness and mass positive, the others at least 0.
void validate(const RodSection& section) {
  require_positive("stretching_stiffness", section.stretching_stiffness);
  require_not_negative("bending_stiffness", section.bending_stiffness);
  require_not_negative("twisting_stiffness", section.twisting_stiffness);
  require_positive("mass_per_length", section.mass_per_length);
  require_not_negative("inertia_per_length", section.inertia_per_length);
  require(section.bending_ratio >= 1.0 && std::isfinite(section.bending_ratio), "bending_ratio",
          section.bending_ratio, "", "at least 1 and finite");
}

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
  if (!section_lengths.empty()) {
    set_sections(count() - 1, {});
  }
  if (!mass_couplings.empty()) {
    mass_couplings.resize(positions.size(), 0.0);
  }
  if (!stiff_sides.empty()) {
    stiff_sides.resize(positions.size());
  }
  if (!edge_radii.empty()) {
    add_edge_radii();
  }
}

}  // namespace fiber

// Rods whose sections differ along them.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "fiber_proximity/sim/rods.hpp"
#include "src/sim/require.hpp"

namespace fiber {

namespace {

void require_all_positive(const RodSection& section) {
  require_positive("stretching_stiffness", section.stretching_stiffness);
  require_positive("bending_stiffness", section.bending_stiffness);
  require_positive("twisting_stiffness", section.twisting_stiffness);
  require_positive("mass_per_length", section.mass_per_length);
  require_positive("inertia_per_length", section.inertia_per_length);
}

void validate_parts(std::uint32_t rod, double length, const std::vector<RodSectionPart>& parts) {
  double end = 0.0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto& [from, to] = parts[i].part;
    if (!(from >= end && from < to && to <= length)) {
      throw std::invalid_argument("rod " + std::to_string(rod) + ": section " + std::to_string(i) +
                                  " is from " + std::to_string(from) + " to " + std::to_string(to) +
                                  " m, it must be behind the one before, " + std::to_string(end) +
                                  " m, and within the rod's length, " + std::to_string(length) +
                                  " m");
    }
    require_all_positive(parts[i].section);
    end = to;
  }
}

/// What a stretch of rod adds up to.
struct Sum {
  double stretching = 0.0;  // lengths of the rod's own section [m]
  double bending = 0.0;
  double twisting = 0.0;
  double mass = 0.0;     // [kg]
  double inertia = 0.0;  // [kg m²]
};

/// Sums between two lengths along a rod.
Sum sum_between(const RodSection& own, const std::vector<RodSectionPart>& parts, double from,
                double to) {
  Sum sum;
  const auto add = [&](const RodSection& section, double length) {
    sum.stretching += length * own.stretching_stiffness / section.stretching_stiffness;
    sum.bending += length * own.bending_stiffness / section.bending_stiffness;
    sum.twisting += length * own.twisting_stiffness / section.twisting_stiffness;
    sum.mass += length * section.mass_per_length;
    sum.inertia += length * section.inertia_per_length;
  };
  double rest = to - from;
  for (const RodSectionPart& each : parts) {
    const double covered = std::min(to, each.part.to) - std::max(from, each.part.from);
    if (covered > 0.0) {
      add(each.section, covered);
      rest -= covered;
    }
  }
  sum.stretching += rest;
  sum.bending += rest;
  sum.twisting += rest;
  sum.mass += rest * own.mass_per_length;
  sum.inertia += rest * own.inertia_per_length;
  return sum;
}

void set_lengths(Rods& rods, std::uint32_t rod, const std::vector<RodSectionPart>& parts) {
  const RodSection& own = rods.sections[rod];
  SectionLengths& lengths = rods.section_lengths;
  double begin = 0.0;   // of the edge after a node
  double before = 0.0;  // the middle of the edge before it
  for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
    const double middle = begin + 0.5 * rods.rest_lengths[i];
    const Sum of_node = sum_between(own, parts, before, middle);
    lengths.bending[i] = of_node.bending;
    lengths.twisting[i] = of_node.twisting;
    if (i + 1 < rods.end(rod)) {
      const Sum of_edge = sum_between(own, parts, begin, begin + rods.rest_lengths[i]);
      lengths.stretching[i] = of_edge.stretching;
      lengths.inertias[i] = of_edge.inertia;
    }
    begin += rods.rest_lengths[i];
    before = middle;
  }
}

}  // namespace

void Rods::set_sections(std::uint32_t rod, const std::vector<RodSectionPart>& parts) {
  const RodSection& own = sections.at(rod);
  const double length =
      std::accumulate(rest_lengths.begin() + first(rod), rest_lengths.begin() + end(rod), 0.0);
  validate_parts(rod, length, parts);
  if (!parts.empty()) {
    require_all_positive(own);
  }
  const std::size_t known = section_lengths.stretching.size();
  for (std::vector<double>* of_all : {&section_lengths.stretching, &section_lengths.bending,
                                      &section_lengths.twisting, &section_lengths.inertias}) {
    of_all->resize(positions.size(), 0.0);
  }
  for (std::uint32_t other = 0; other < count(); ++other) {
    if (other != rod && first(other) >= known) {
      set_lengths(*this, other, {});
    }
  }
  set_lengths(*this, rod, parts);
  if (parts.empty()) {
    return;
  }
  double begin = 0.0;   // of the edge after a node
  double before = 0.0;  // the middle of the edge before it
  for (std::uint32_t i = first(rod); i < end(rod); ++i) {
    const double middle = begin + 0.5 * rest_lengths[i];
    masses[i] +=
        sum_between(own, parts, before, middle).mass - own.mass_per_length * (middle - before);
    begin += rest_lengths[i];
    before = middle;
  }
}

}  // namespace fiber

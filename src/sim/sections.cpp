// Rods whose sections differ along them.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
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

/// The edges of a part that goes from node to node.
struct EdgeRange {
  std::uint32_t first;
  std::uint32_t end;
};

/// The edges of a part, if it goes from node to node: whoever makes it adds up the same lengths.
std::optional<EdgeRange> edges_of(const Rods& rods, std::uint32_t rod, const RodPart& part) {
  std::optional<std::uint32_t> first;
  double at = 0.0;
  for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
    if (at == part.from) {
      first = i;
    }
    if (first && at == part.to) {
      return EdgeRange{*first, i};
    }
    at += rods.rest_lengths[i];
  }
  return std::nullopt;
}

[[noreturn]] void refuse_part(std::uint32_t rod, std::size_t part, const std::string& problem) {
  throw std::invalid_argument("rod " + std::to_string(rod) + ": section " + std::to_string(part) +
                              " " + problem);
}

void validate_own_edges(const Rods& rods, std::uint32_t rod,
                        const std::vector<RodSectionPart>& parts) {
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const RodSectionPart& part = parts[i];
    if (!part.radius && !part.is_rigid) {
      continue;
    }
    const auto edges = edges_of(rods, rod, part.part);
    if (!edges) {
      refuse_part(rod, i,
                  "has a radius of its own or is rigid, it must go from one node to another, not "
                  "from " +
                      std::to_string(part.part.from) + " to " + std::to_string(part.part.to) +
                      " m");
    }
    if (part.radius && !(std::isfinite(*part.radius) && *part.radius > 0.0)) {
      refuse_part(
          rod, i,
          "has the radius " + std::to_string(*part.radius) + ", it must be positive and finite");
    }
    if (part.is_rigid && edges->end != edges->first + 1) {
      refuse_part(rod, i,
                  "is rigid and of " + std::to_string(edges->end - edges->first) +
                      " edges, it must be one");
    }
    if (part.is_rigid && i > 0 && parts[i - 1].is_rigid && parts[i - 1].part.to == part.part.from) {
      refuse_part(rod, i, "is rigid as the one right before it: they must be one");
    }
  }
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

/// The sums over a stretch of rod.
struct Sum {
  double stretching = 0.0;  // lengths of the rod's own section [m]
  double bending = 0.0;
  double stiff = 0.0;
  double twisting = 0.0;
  double mass = 0.0;     // [kg]
  double inertia = 0.0;  // [kg m²]
};

/// Sums between two lengths along a rod.
/// @param is_inner whether they are about a node inside of the rod, where rigid parts do not give
///                 way; at an end, that is what a clamp holds
Sum sum_between(const RodSection& own, const std::vector<RodSectionPart>& parts, double from,
                double to, bool is_inner = false) {
  Sum sum;
  const auto add = [&](const RodSection& section, double length, bool gives_way) {
    sum.stretching += length * own.stretching_stiffness / section.stretching_stiffness;
    if (gives_way) {
      const double bending = length * own.bending_stiffness / section.bending_stiffness;
      sum.bending += bending;
      sum.stiff += bending / section.bending_ratio;
      sum.twisting += length * own.twisting_stiffness / section.twisting_stiffness;
    }
    sum.mass += length * section.mass_per_length;
    sum.inertia += length * section.inertia_per_length;
  };
  double rest = to - from;
  for (const RodSectionPart& each : parts) {
    const double covered = std::min(to, each.part.to) - std::max(from, each.part.from);
    if (covered > 0.0) {
      add(each.section, covered, !(is_inner && each.is_rigid));
      rest -= covered;
    }
  }
  sum.stretching += rest;
  sum.bending += rest;
  sum.stiff += rest / own.bending_ratio;
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
    const bool is_inner = i > rods.first(rod) && i + 1 < rods.end(rod);
    const Sum of_node = sum_between(own, parts, before, middle, is_inner);
    lengths.bending[i] = of_node.bending;
    lengths.stiff[i] = of_node.stiff;
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

void couple_masses(Rods& rods, std::uint32_t rod, const std::vector<RodSectionPart>& parts) {
  for (const RodSectionPart& part : parts) {
    if (part.is_rigid) {
      rods.mass_couplings.resize(rods.positions.size(), 0.0);
      const std::uint32_t edge = edges_of(rods, rod, part.part).value().first;
      rods.mass_couplings[edge] =
          part.section.mass_per_length * (part.part.to - part.part.from) / 6.0;
    }
  }
}

/// Gives the edges of parts their radii.
void set_radii(Rods& rods, std::uint32_t rod, const std::vector<RodSectionPart>& parts) {
  if (std::none_of(parts.begin(), parts.end(),
                   [](const RodSectionPart& part) { return part.radius.has_value(); })) {
    return;
  }
  rods.add_edge_radii();
  for (const RodSectionPart& part : parts) {
    if (part.radius) {
      const EdgeRange edges = edges_of(rods, rod, part.part).value();
      std::fill(rods.edge_radii.begin() + edges.first, rods.edge_radii.begin() + edges.end,
                *part.radius);
    }
  }
  rods.radii[rod] = *std::max_element(rods.edge_radii.begin() + rods.first(rod),
                                      rods.edge_radii.begin() + rods.end(rod) - 1);
}

}  // namespace

void Rods::add_edge_radii() {
  for (std::uint32_t rod = 0; rod < count(); ++rod) {
    if (first(rod) >= edge_radii.size()) {
      edge_radii.resize(end(rod), radii[rod]);
    }
  }
}

double Rods::node_radius(std::uint32_t rod, std::uint32_t node) const {
  if (edge_radii.empty()) {
    return radii[rod];
  }
  const std::uint32_t before = node > first(rod) ? node - 1 : is_closed(rod) ? end(rod) - 2 : node;
  const std::uint32_t after = node + 1 < end(rod) ? node : is_closed(rod) ? first(rod) : node - 1;
  return std::max(edge_radii[before], edge_radii[after]);
}

std::vector<double> Rods::assembly_radii() const {
  if (edge_radii.empty()) {
    return radii;
  }
  std::vector<double> of_points;
  for (std::uint32_t rod = 0; rod < count(); ++rod) {
    const std::size_t begin = of_points.size();
    const std::uint32_t edges = node_count(rod) - 1;
    const double* const of_edges = edge_radii.data() + first(rod);
    const bool is_ring = is_closed(rod);
    for (std::uint32_t i = 0; i <= edges; ++i) {
      const std::uint32_t before = i > 0 ? i - 1 : is_ring ? edges - 1 : 0;
      const std::uint32_t after = i < edges ? i : is_ring ? 0 : edges - 1;
      of_points.push_back(std::min(of_edges[before], of_edges[after]));
    }
    for (std::uint32_t i = 0; i < edges; ++i) {
      double& first_end = of_points[begin + i];
      if (std::max(first_end, of_points[begin + i + 1]) < of_edges[i]) {
        first_end = of_edges[i];
      }
    }
    if (is_ring) {
      of_points.back() = of_points[begin];
    }
  }
  return of_points;
}

void Rods::set_sections(std::uint32_t rod, const std::vector<RodSectionPart>& parts) {
  const RodSection& own = sections.at(rod);
  const double length =
      std::accumulate(rest_lengths.begin() + first(rod), rest_lengths.begin() + end(rod), 0.0);
  validate_parts(rod, length, parts);
  validate_own_edges(*this, rod, parts);
  if (!parts.empty()) {
    require_all_positive(own);
  }
  const std::size_t known = section_lengths.stretching.size();
  for (std::vector<double>* of_all :
       {&section_lengths.stretching, &section_lengths.bending, &section_lengths.stiff,
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
  set_radii(*this, rod, parts);
  couple_masses(*this, rod, parts);
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

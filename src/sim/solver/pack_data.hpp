// Data of rods on its way into packs and out of them.
#pragma once

#include <cstddef>
#include <cstdint>

#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

/// Calls function(lane, place, node) for the nodes of the first lanes, with the place of the node's
/// first unknown in the pack and the node's index in Rods.
template <class Function>
void for_each_node(const RodPack& pack, std::size_t lanes, const Function& function) {
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    for (std::uint32_t i = 0; i < pack.node_count; ++i) {
      function(lane, i * pack.unknowns, pack.first_nodes[lane] + i);
    }
  }
}

/// Loads the lengths of rods whose sections differ along them; those at the ends of a rod are of
/// half an edge.
inline void load_section_lengths(const SectionLengths& lengths, RodPack& pack) {
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const std::uint32_t first = pack.first_nodes[lane];
    for (std::uint32_t i = 0; i < pack.node_count; ++i) {
      pack.inverse_bending_lengths[i][lane] = 1.0 / lengths.bending[first + i];
      if (i + 1 < pack.node_count) {
        pack.inverse_stretching_lengths[i][lane] = 1.0 / lengths.stretching[first + i];
      }
      if (pack.unknowns == 4) {
        pack.inverse_twisting_lengths[i][lane] = 1.0 / lengths.twisting[first + i];
      }
    }
  }
}

/// Loads the stiffnesses, masses and lengths, which do not change in a step.
inline void load_constants(const Rods& rods, RodPack& pack) {
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const std::uint32_t first = pack.first_nodes[lane];
    const RodSection& section = rods.sections[pack.rods[lane]];
    pack.stretching_stiffness[lane] = section.stretching_stiffness;
    pack.bending_stiffness[lane] = section.bending_stiffness;
    pack.twisting_stiffness[lane] = section.twisting_stiffness;
    for (std::uint32_t i = 0; i < pack.node_count; ++i) {
      const double length = rods.rest_lengths[first + i];
      pack.masses[i][lane] = rods.masses[first + i];
      pack.rest_lengths[i][lane] = length;
      if (i + 1 < pack.node_count) {
        const double before = i > 0 ? rods.rest_lengths[first + i - 1] : length;
        pack.inverse_stretching_lengths[i][lane] = 1.0 / length;
        pack.inverse_bending_lengths[i][lane] = 2.0 / (before + length);
      }
    }
  }
  if (pack.unknowns == 4) {
    pack.inverse_twisting_lengths = pack.inverse_bending_lengths;
  }
  pack.has_sections = !rods.section_lengths.empty();
  if (pack.has_sections) {
    load_section_lengths(rods.section_lengths, pack);
  }
}

/// Loads an effect's data of the rods' nodes.
inline void load_values(const Effect& effect, const RodPack& pack, NodeValues& values) {
  const auto [data, count] = effect.per_node_data();
  values.resize(std::size_t{count} * pack.node_count);
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const std::uint32_t first = pack.first_nodes[lane];
    for (std::uint32_t i = 0; i < pack.node_count; ++i) {
      for (std::size_t k = 0; k < count; ++k) {
        values[count * i + k][lane] = data[std::size_t{count} * (first + i) + k];
      }
    }
  }
}

/// Stores positions and angles.
inline void store(const RodPack& pack, Rods& rods) {
  for_each_node(pack, pack.used, [&](std::size_t lane, std::size_t place, std::uint32_t node) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      rods.positions[node][k] = pack.positions[place + k][lane];
    }
    if (pack.unknowns == 4) {
      rods.angles[node] = pack.positions[place + 3][lane];
    }
  });
}

}  // namespace fiber

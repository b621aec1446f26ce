// Which fibres, nodes and parts of fibres an entry of an effect's list is about.
#pragma once

#include <optional>
#include <vector>

#include "fiber_proximity/sim/scene/scene.hpp"

namespace fiber {

/// Indices of the fibres of this name, or of the entry of this name.
/// @throws std::invalid_argument naming file, line and value, and the names there are
std::vector<std::uint32_t> find_fibers(const YamlField& name, const std::vector<SimFiber>& fibers);

/// Reads `first`, `last` or an index; the first node if there is no field.
/// @param count of the fibre's nodes
/// @throws std::invalid_argument naming file, line and value, and what is allowed
std::uint32_t read_node(const std::optional<YamlField>& node, std::uint32_t count);

/// Reads the keys `from` and `to` of an entry [m], lengths along the fibre's shape; the fibre's
/// ends for what is not given.
/// @param length of the shape [m]
/// @throws std::invalid_argument naming file, line and value, for a part that leaves the fibre or
///         has no length
RodPart read_part(const YamlField& entry, double length);

/// A part of a fibre's shape as a part of its edges, which together are a little shorter.
/// @param length of the shape [m]
RodPart along_edges(const RodPart& part, double length, const Rods& rods, std::uint32_t rod);

}  // namespace fiber

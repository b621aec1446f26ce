// Parts of fibres that have materials and radii of their own, or are rigid.
#pragma once

#include <string>
#include <vector>

#include "src/sim/scene/cut_curve.hpp"
#include "src/sim/scene/fibers.hpp"

namespace fiber {

/// A preset's name, or the moduli and so on; with both, these replace the preset's.
/// @param otherwise what is taken for values that neither of them gives
/// @param defaults  these values, and what is taken
RodMaterial read_material(const YamlField& field, const RodMaterial& otherwise,
                          std::string& defaults);

/// The section of a fibre where its entry gives no other.
struct FiberBody {
  RodMaterial material;
  double radius = 0.0;  ///< [m]
  double length = 0.0;  ///< of the curve [m]
};

/// Reads the list `sections` of a fibre, if there is one.
/// @throws std::invalid_argument naming file, line, field and value, and what is allowed
std::vector<SectionEntry> read_sections(const YamlField& fiber, const FiberBody& body);

/// The nodes that a fibre has at its joints, and where sections begin and end that have radii of
/// their own or are rigid; a rigid one is one segment.
/// @throws std::invalid_argument naming what has too few segments, or the rigid section that is
///         shorter than a segment, is not straight or has a joint inside
NodesAt nodes_of(const FiberEntry& fiber, std::int64_t segments);

/// Gives the last rod, which is that of an entry, its sections.
void set_sections(const FiberEntry& entry, const NodesAt& nodes, Rods& rods);

}  // namespace fiber

#pragma once

#include <cstdint>
#include <vector>

#include "src/sim/joint/weld.hpp"

namespace fiber {

/// A node that is joined.
struct PlacedNode {
  std::uint32_t rod;
  std::uint32_t node;  ///< as Rods counts nodes
};

/// The joints of rods, as the solver has them.
struct JointParts {
  std::vector<std::vector<PlacedNode>> places;  ///< of two nodes or more each
  std::vector<std::int32_t> joints;             ///< by place; -1 for the end of a closed rod
  std::vector<Weld> welds;                      ///< of nodes of one place each
};

/// The mean of a quantity of a place's nodes, by their masses.
/// @param value of a node
template <class Value>
auto mean_at(const std::vector<PlacedNode>& place, const std::vector<double>& masses,
             const Value& value) {
  double mass = masses[place.front().node];
  auto sum = (mass * value(place.front().node)).eval();
  for (std::size_t i = 1; i < place.size(); ++i) {
    const std::uint32_t node = place[i].node;
    sum += masses[node] * value(node);
    mass += masses[node];
  }
  return (sum / mass).eval();
}

}  // namespace fiber

#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace fiber {

/// The nodes of a fibre by the shares of its length at which they are to be.
using NodesAt = std::map<double, std::uint32_t>;

/// Where parts of a fibre begin and end that are rigid, in shares of its length, one behind the
/// other.
using RigidShares = std::vector<std::pair<double, double>>;

/// The nodes nearest to some shares of a fibre's length; the ends only for 0 and 1.
/// @param shares rising, each once
/// @param rigid  parts of one segment each, the others being of equal length; their ends are among
///               the shares
/// @throws std::invalid_argument naming two shares that are less than a segment apart
NodesAt nodes_at(const std::vector<double>& shares, std::int64_t segments,
                 const RigidShares& rigid = {});

/// Points along a polyline at equal arc lengths from each of some nodes to the next, which are at
/// their shares of its length.
/// @param line of some length
/// @returns segments + 1 points [m]
std::vector<Eigen::Vector3d> cut_curve(const std::vector<Eigen::Vector3d>& line,
                                       std::int64_t segments, const NodesAt& nodes);

}  // namespace fiber

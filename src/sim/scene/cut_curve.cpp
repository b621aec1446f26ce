#include "src/sim/scene/cut_curve.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "src/sim/scene/parts.hpp"

namespace fiber {

using Eigen::Vector3d;

NodesAt nodes_at(const std::vector<double>& shares, std::int64_t segments) {
  NodesAt nodes;
  for (const double share : shares) {
    const auto nearest =
        static_cast<std::int64_t>(std::llround(share * static_cast<double>(segments)));
    const std::int64_t node = share == 0.0   ? 0
                              : share == 1.0 ? segments
                                             : std::clamp<std::int64_t>(nearest, 1, segments - 1);
    const auto number = static_cast<std::uint32_t>(node);
    if ((!nodes.empty() && std::prev(nodes.end())->second >= number) ||
        (segments == 1 && share != 0.0 && share != 1.0)) {
      throw std::invalid_argument(format(
          "its ", segments, " segment(s) are too few for a joint at ", share,
          nodes.empty() ? std::string() : format(" beside one at ", std::prev(nodes.end())->first),
          " of its length"));
    }
    nodes[share] = number;
  }
  return nodes;
}

std::vector<Vector3d> cut_curve(const std::vector<Vector3d>& line, std::int64_t segments,
                                const NodesAt& nodes) {
  NodesAt ends = nodes;
  ends[0.0] = 0;
  ends[1.0] = static_cast<std::uint32_t>(segments);
  std::vector<double> lengths{0.0};
  for (std::size_t i = 1; i < line.size(); ++i) {
    lengths.push_back(lengths.back() + (line[i] - line[i - 1]).norm());
  }
  std::vector<Vector3d> points;
  std::size_t piece = 0;
  for (auto from = ends.begin(); std::next(from) != ends.end(); ++from) {
    const auto to = std::next(from);
    for (std::uint32_t i = from->second; i < to->second; ++i) {
      const double part = static_cast<double>(i - from->second) / (to->second - from->second);
      const double at = lengths.back() * (from->first + part * (to->first - from->first));
      while (piece + 2 < line.size() && lengths[piece + 1] <= at) {
        ++piece;
      }
      const double share = (at - lengths[piece]) / (lengths[piece + 1] - lengths[piece]);
      points.push_back(line[piece] + share * (line[piece + 1] - line[piece]));
    }
  }
  points.push_back(line.back());
  return points;
}

}  // namespace fiber

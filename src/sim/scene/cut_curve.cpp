#include "src/sim/scene/cut_curve.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>

#include "src/sim/scene/parts.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// How far along the rest of a fibre something is, and how many rigid parts are before it.
struct Along {
  double share;  // of the rest's length
  std::int64_t rigid;
};

/// The share of the length that is not rigid.
double rest_of(const RigidShares& rigid) {
  double rest = 1.0;
  for (const auto& [from, to] : rigid) {
    rest -= to - from;
  }
  return rest;
}

Along along_rest(double share, const RigidShares& rigid) {
  const double total = rest_of(rigid);
  Along along{0.0, 0};
  double begin = 0.0;
  for (const auto& [from, to] : rigid) {
    if (share < to) {
      break;
    }
    along.share += from - begin;
    begin = to;
    ++along.rigid;
  }
  along.share += share - begin;
  along.share = total > 0.0 && !rigid.empty() ? along.share / total : along.share;
  return along;
}

NodesAt with_ends(NodesAt nodes, std::int64_t segments) {
  nodes[0.0] = 0;
  nodes[1.0] = static_cast<std::uint32_t>(segments);
  return nodes;
}

/// Segments that are much shorter than the others are stiffer by that to the third power, and
/// forces on them do not balance.
void require_no_slivers(const NodesAt& ends, std::int64_t edges, const RigidShares& rigid) {
  constexpr double least = 0.01;
  const double mean = rest_of(rigid) / static_cast<double>(edges);
  for (auto from = ends.begin(), to = std::next(from); to != ends.end(); from = to++) {
    const bool is_rigid =
        std::find(rigid.begin(), rigid.end(), std::pair(from->first, to->first)) != rigid.end();
    const double part = (to->first - from->first) / (to->second - from->second) / mean;
    if (!is_rigid && part < least) {
      throw std::invalid_argument(
          format("between ", std::to_string(from->first), " and ", std::to_string(to->first),
                 " of its length, where it, "
                 "joints or sections end, segments would have ",
                 part, " of the length of others, at least ", least, " is allowed"));
    }
  }
}

}  // namespace

NodesAt nodes_at(const std::vector<double>& shares, std::int64_t segments,
                 const RigidShares& rigid) {
  const std::int64_t edges = segments - static_cast<std::int64_t>(rigid.size());
  const double rest = rest_of(rigid);
  constexpr double min_rest = 1e-6;  // below, its segments are hardly longer than rounding
  if (edges > 0 && rest < min_rest) {
    throw std::invalid_argument(format("its rigid sections leave ", std::max(0.0, rest),
                                       " of its length to ", edges, " of its ", segments,
                                       " segments: each of them is one segment"));
  }
  const bool ends_rigid = !rigid.empty() && rigid.back().second == 1.0;
  NodesAt nodes;
  for (const double share : shares) {
    const Along along = along_rest(share, rigid);
    const auto nearest =
        static_cast<std::int64_t>(std::llround(along.share * static_cast<double>(edges)));
    const bool is_last = share == 1.0 || (ends_rigid && share == rigid.back().first);
    const bool is_first = share == 0.0 || (!rigid.empty() && rigid.front().first == 0.0 &&
                                           share == rigid.front().second);
    const std::int64_t node =
        is_first  ? 0
        : is_last ? edges
                  : std::clamp<std::int64_t>(nearest, 1, std::max<std::int64_t>(1, edges - 1));
    const auto number = static_cast<std::uint32_t>(std::max<std::int64_t>(0, node + along.rigid));
    if ((!nodes.empty() && std::prev(nodes.end())->second >= number) ||
        (edges <= 1 && !is_first && !is_last) || edges < 0) {
      throw std::invalid_argument(format(
          "its ", segments, " segment(s) are too few for a joint or the end of a section at ",
          share,
          nodes.empty() ? std::string() : format(" beside one at ", std::prev(nodes.end())->first),
          " of its length"));
    }
    nodes[share] = number;
  }
  if (!nodes.empty()) {
    require_no_slivers(with_ends(nodes, segments), edges, rigid);
  }
  return nodes;
}

std::vector<Vector3d> cut_curve(const std::vector<Vector3d>& line, std::int64_t segments,
                                const NodesAt& nodes) {
  const NodesAt ends = with_ends(nodes, segments);
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

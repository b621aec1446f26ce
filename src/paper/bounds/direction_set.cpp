#include "src/paper/bounds/direction_set.hpp"

#include <array>
#include <stdexcept>
#include <string>

namespace fiber {
namespace {

constexpr int smallest_k = 6;
constexpr int largest_k = 200;
constexpr int set_count = (largest_k - smallest_k) / 2 + 1;

constexpr double table[][3] = {
#include "src/paper/bounds/direction_table.inc"
};
constexpr int line_count = (smallest_k / 2 + largest_k / 2) * set_count / 2;
static_assert(sizeof(table) / sizeof(table[0]) == line_count);

using DirectionSet = std::vector<Eigen::Vector3d>;

std::array<DirectionSet, set_count> all_sets() {
  std::array<DirectionSet, set_count> sets;
  const auto* line = std::begin(table);
  for (int i = 0; i < set_count; ++i) {
    for (int n = 0; n < smallest_k / 2 + i; ++n, ++line) {
      sets[i].emplace_back((*line)[0], (*line)[1], (*line)[2]);
    }
  }
  return sets;
}

DirectionSet normalised(DirectionSet directions) {
  for (Eigen::Vector3d& direction : directions) {
    direction.normalize();
  }
  return directions;
}

DirectionSet joined(DirectionSet first, const DirectionSet& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace

const DirectionSet& grassmannian_directions(int k) {
  static const std::array<DirectionSet, set_count> sets = all_sets();
  if (k < smallest_k || k > largest_k || k % 2 != 0) {
    throw std::invalid_argument("k-DOP with k = " + std::to_string(k) + ": k must be even, from " +
                                std::to_string(smallest_k) + " to " + std::to_string(largest_k));
  }
  return sets[(k - smallest_k) / 2];
}

const DirectionSet& classic_directions(int k) {
  static const DirectionSet axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  static const DirectionSet corners = normalised({{1, 1, 1}, {1, -1, 1}, {1, 1, -1}, {1, -1, -1}});
  static const DirectionSet edges =
      normalised({{1, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, -1, 0}, {1, 0, -1}, {0, 1, -1}});
  static const DirectionSet axes_and_corners = joined(axes, corners);
  static const DirectionSet axes_and_edges = joined(axes, edges);
  static const DirectionSet axes_corners_and_edges = joined(axes_and_corners, edges);
  switch (k) {
    case 6:
      return axes;
    case 14:
      return axes_and_corners;
    case 18:
      return axes_and_edges;
    case 26:
      return axes_corners_and_edges;
    default:
      throw std::invalid_argument("classic k-DOP with k = " + std::to_string(k) +
                                  ": k must be 6, 14, 18 or 26");
  }
}

}  // namespace fiber

#pragma once

#include <algorithm>
#include <vector>

#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

/// Takes the nodes of each of Rods::joints to one point: their mean, or that of those which are
/// held.
/// @param is_held by node
inline void unite_joints(Rods& rods, const std::vector<bool>& is_held) {
  struct Sum {
    Eigen::Vector3d points = Eigen::Vector3d::Zero();
    double count = 0.0;
    bool is_held = false;
  };
  std::vector<Sum> sums;
  for (std::size_t i = 0; i < rods.joints.size(); ++i) {
    if (rods.joints[i] < 0) {
      continue;
    }
    const auto joint = static_cast<std::size_t>(rods.joints[i]);
    sums.resize(std::max(sums.size(), joint + 1));
    Sum& sum = sums[joint];
    if (is_held[i] && !sum.is_held) {
      sum = {Eigen::Vector3d::Zero(), 0.0, true};
    }
    if (is_held[i] == sum.is_held) {
      sum.points += rods.positions[i];
      sum.count += 1.0;
    }
  }
  for (std::size_t i = 0; i < rods.joints.size(); ++i) {
    if (rods.joints[i] >= 0) {
      const Sum& sum = sums[static_cast<std::size_t>(rods.joints[i])];
      rods.positions[i] = sum.points / sum.count;
    }
  }
}

}  // namespace fiber

#pragma once

#include <vector>

#include "test/support/random.hpp"

namespace fiber::test {

/// A polyline that turns by random angles of up to about `bend` at its nodes.
inline std::vector<Eigen::Vector3d> polyline(Random& random, const Eigen::Vector3d& direction,
                                             int edges, double length, double bend) {
  std::vector<Eigen::Vector3d> points{Eigen::Vector3d::Zero()};
  Eigen::Vector3d along = direction;
  for (int i = 0; i < edges; ++i) {
    points.push_back(points.back() + length * along);
    along = (along + bend * random.direction()).normalized();
  }
  return points;
}

}  // namespace fiber::test

#pragma once

#include <vector>

#include "fiber_proximity/query/crossings.hpp"
#include "test/support/exact_pairs.hpp"
#include "test/support/random.hpp"

namespace fiber::test {

inline View along(const Eigen::Vector3d& direction) {
  View view;
  view.direction = direction;
  return view;
}

inline View from(const Eigen::Vector3d& eye, const Eigen::Vector3d& direction) {
  View view;
  view.direction = direction;
  view.is_perspective = true;
  view.eye = eye;
  return view;
}

inline int sum_of_signs(const std::vector<Crossing>& crossings) {
  int sum = 0;
  for (const Crossing& crossing : crossings) {
    sum += crossing.sign;
  }
  return sum;
}

/// Either kind of view, of fibres around a point.
inline View random_view(Random& random, const Eigen::Vector3d& middle = Eigen::Vector3d::Zero(),
                        double size = 1.0) {
  return random.chance(0.5) ? along(random.uniform(0.1, 10.0) * random.direction())
                            : from(middle + size * random.in_cube(2.0), random.direction());
}

inline std::vector<Key> keys_of(const std::vector<Crossing>& crossings) {
  std::vector<Key> keys;
  for (const Crossing& crossing : crossings) {
    keys.emplace_back(crossing.key());
  }
  return keys;
}

}  // namespace fiber::test

#pragma once

#include <string>
#include <vector>

#include "test/io/format.hpp"

namespace fiber::test {

/// Points 0 to 4 at (i, -i, i / 2), of which a line has 3 0 1 and another one 1 4.
inline std::vector<double> vtk_coordinates() {
  std::vector<double> numbers;
  for (int i = 0; i < 5; ++i) {
    numbers.insert(numbers.end(), {1.0 * i, -1.0 * i, 0.5 * i});
  }
  return numbers;
}
inline const std::vector<std::uint64_t> vtk_ids{3, 0, 1, 1, 4};
inline const std::vector<double> vtk_radii{0.5, 0.25, 8, 1, 2};

/// The fibres of these lines, with the radii or with a default one; they meet at point 1.
inline FiberAssembly vtk_fibers(bool has_radii, double radius = 0.0) {
  const auto point = [](int i) { return Eigen::Vector3d(i, -i, 0.5 * i); };
  FiberTopology topology;
  topology.joints = {-1, -1, 0, 0, -1};
  return {{point(3), point(0), point(1), point(1), point(4)},
          {0, 3, 5},
          has_radii ? std::vector<double>{1, 0.5, 0.25, 0.25, 2} : std::vector<double>{radius},
          topology};
}

}  // namespace fiber::test

#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "test/support/answers.hpp"
#include "test/support/engines_test.hpp"
#include "test/support/motions.hpp"

namespace fiber::test {

class MotionQueries : public EnginesTest {
 protected:
  MotionResult ask_motion(const FiberAssembly& before, const FiberAssembly& after,
                          const MotionOptions& options) const {
    MotionResult result = answer(GetParam(), before, after, options);
    EXPECT_TRUE(result.complete);
    return result;
  }
};

/// One straight fibre above another, which comes down through it.
inline std::vector<Eigen::Vector3d> straight(double z, bool along_x) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= 20; ++i) {
    const double x = -0.5 + 0.05 * i;
    points.push_back(along_x ? Eigen::Vector3d(x, 0.01, z) : Eigen::Vector3d(0.01, x, z));
  }
  return points;
}

inline FiberAssembly crossed_cables(double z) {
  return as_fibers({straight(0.0, true), straight(z, false)}, 0.002);
}

}  // namespace fiber::test

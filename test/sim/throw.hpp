#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "test/sim/solver_path.hpp"
#include "test/sim/tunnelling.hpp"
#include "test/support/random.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {

/// A bent chain from a point.
inline std::vector<Eigen::Vector3d> chain(Random& random, const Eigen::Vector3d& middle, int edges,
                                          double length) {
  std::vector<Eigen::Vector3d> points{middle};
  Eigen::Vector3d direction = random.direction();
  for (int i = 0; i < edges; ++i) {
    points.push_back(points.back() + length / edges * direction);
    direction = (direction + 0.4 * random.direction()).normalized();
  }
  return points;
}

/// Follows rods that are thrown at each other in steps so long that contacts appear, vanish and
/// slide within one.
struct Throw {
  Throw(Rods rods, Effects effects, std::unique_ptr<Contacts> contacts) {
    effects.push_back(path.watcher());
    StepperOptions options;
    options.threads = 1;
    stepper = std::make_unique<Stepper>(std::move(rods), std::move(effects), options,
                                        std::move(contacts));
  }

  void run(int steps, double length) const {
    for (int i = 0; i < steps; ++i) {
      stepper->step(length);
      ASSERT_TRUE(all_finite(stepper->rods())) << "step " << i;
      ASSERT_EQ(TunnellingChecker::check(stepper->rods(), path), "") << "step " << i;
    }
  }

  SolverPath path;
  std::unique_ptr<Stepper> stepper;
};

}  // namespace fiber::test

// Nothing passes through obstacles, however thin they are and however fast it is thrown.

#include <gtest/gtest.h>

#include "test/environment/random_shapes.hpp"
#include "test/sim/throw.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

class Obstacle : public testing::TestWithParam<double> {};

TEST_P(Obstacle, ThinPlatesKeepNodesOnTheirSide) {
  SCOPED_TRACE(seed_message());
  Random random(4);
  const double thickness = 1e-4;
  for (const Shape& plate : {Shape(BoxShape{Vector3d(2.0, 2.0, thickness)}), Shape(PlaneShape{}),
                             Shape(box_mesh({2.0, 2.0, thickness}, 3))}) {
    Rods rods;
    for (int rod = 0; rod < 3; ++rod) {
      rods.add(chain(random, {0.0, 0.1 * rod, 0.5}, 8, 0.3), 0.001, rubber(0.001));
      for (std::uint32_t node = rods.first(rod); node < rods.end(rod); ++node) {
        rods.velocities[node] = Vector3d(random.uniform(-1.0, 1.0), 0.0, -GetParam());
      }
    }
    Stepper stepper(rods, elastic(standard_gravity), StepperOptions{},
                    contacts_with(environment_of(plate), 0.3));
    for (int i = 0; i < 60; ++i) {
      stepper.step(1.0 / 60.0);
      ASSERT_TRUE(all_finite(stepper.rods())) << "step " << i;
      for (const Vector3d& position : stepper.rods().positions) {
        // Off the rim of the plate they may fall.
        ASSERT_TRUE(position.z() > 0.0 || position.head<2>().cwiseAbs().maxCoeff() > 1.0)
            << "step " << i << ": " << position.transpose();
      }
    }
  }
}

TEST_P(Obstacle, AThinPostStopsEdges) {
  SCOPED_TRACE(seed_message());
  Random random(5);
  const Eigen::Isometry3d along_x(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY()));
  for (int repeat = 0; repeat < 10; ++repeat) {
    Rods rods;
    const double slant = random.uniform(-1.0, 1.0);
    const double shift = random.uniform(-0.02, 0.02);
    const double height = repeat % 2 == 0 ? 0.3 : 0.005;
    const double slope = 0.1 * height * slant;
    rods.add(straight({0.0, -0.2 + shift, height + slope}, {0.0, 0.2 + shift, height - slope}, 7),
             0.001, rubber(0.001));
    for (Vector3d& velocity : rods.velocities) {
      velocity = Vector3d(0.0, random.uniform(-0.5, 0.5), -GetParam());
    }
    const Throw thrown(rods, elastic(),
                       contacts_with(environment_of(CylinderShape{1e-3, 2.0}, along_x), 0.3));
    for (int i = 0; i < 60; ++i) {
      thrown.run(1, 1.0 / 60.0);
      ASSERT_FALSE(TunnellingChecker::passes(thrown.stepper->rods(), thrown.path,
                                             -Vector3d::UnitX(), Vector3d::UnitX()))
          << "step " << i;
    }
  }
}

TEST_P(Obstacle, MeshesAreOnBothSides) {
  // The lower of two sheets is nearer, the upper is what the rod flies to.
  constexpr double upper = 0.03;
  std::vector<Vector3d> vertices;
  for (const double z : {0.0, upper}) {
    for (const double x : {-1.0, 1.0}) {
      vertices.emplace_back(x, -1.0, z);
      vertices.emplace_back(x, 1.0, z);
    }
  }
  const auto mesh = std::make_shared<const TriangleMesh>(
      vertices, std::vector<TriangleMesh::Triangle>{{0, 1, 2}, {1, 2, 3}, {4, 5, 6}, {5, 6, 7}});
  Rods rods;
  rods.add(straight({-0.1, 0.0, 0.01}, {0.1, 0.02, 0.012}, 8), 0.001, rubber(0.001));
  for (Vector3d& velocity : rods.velocities) {
    velocity.z() = GetParam();
  }
  Stepper stepper(rods, elastic(), StepperOptions{}, contacts_with(environment_of(mesh), 0.3));
  for (int i = 0; i < 60; ++i) {
    stepper.step(1.0 / 60.0);
    ASSERT_TRUE(all_finite(stepper.rods())) << "step " << i;
    for (const Vector3d& position : stepper.rods().positions) {
      ASSERT_GT(position.z(), 0.0) << "step " << i;
      ASSERT_LT(position.z(), upper) << "step " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(AtSpeeds, Obstacle, testing::Values(0.5, 5.0, 50.0));

}  // namespace
}  // namespace fiber::test

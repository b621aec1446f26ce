// Steps allocate nothing once a scene has come to its steady state, whatever the scene names.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "test/sim/cost_scenes.hpp"
#include "test/sim/counted_memory.hpp"
#include "test/sim/joint_scenes.hpp"
#include "validation/sim/moving_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// A scene and how many of its steps it takes to come to its steady state.
struct SteadyScene {
  std::string name;
  std::function<std::unique_ptr<Stepper>(const StepperOptions& options)> make;
  int settling = 20;
};

/// Scenes of rods that nothing joins and nothing touches.
std::vector<SteadyScene> scenes_of_effects() {
  std::vector<NamedEffect> all = effects_with_state();
  all.push_back({"base", base});
  std::vector<SteadyScene> scenes;
  for (const NamedEffect& effect : all) {
    scenes.push_back({effect.name, [effect](const StepperOptions& options) {
                        Rods rods = stacked(4, 30, 0.1);
                        Effects effects = effect.make(rods);
                        return std::make_unique<Stepper>(std::move(rods), std::move(effects),
                                                         options);
                      }});
  }
  scenes.push_back({"sections", [](const StepperOptions& options) {
                      Rods rods = stacked(2, 30, 0.1);
                      rods.set_sections(0, {{{0.1, 0.2}, rubber(0.004)}});
                      return std::make_unique<Stepper>(std::move(rods), elastic(standard_gravity),
                                                       options);
                    }});
  return scenes;
}

/// Rods that are joined or closed.
std::vector<SteadyScene> scenes_of_joints() {
  std::vector<SteadyScene> scenes;
  for (const Joints::Kind kind : {Joints::Kind::BALL, Joints::Kind::WELD}) {
    for (const bool has_twist : {false, true}) {
      JointScene scene;
      scene.has_twist = has_twist;
      scene.relaxation_time = 0.01;
      const std::string name = kind == Joints::Kind::BALL ? "ball" : "weld";
      scenes.push_back(
          {name + (has_twist ? " with twist" : ""), [=](const StepperOptions& options) {
             Rods rods = branches();
             Effects effects = effects_of(rods, scene);
             auto joints = joints_of(scene);
             joints->add(rods, branching(kind));
             return std::make_unique<Stepper>(std::move(rods), std::move(effects), options, nullptr,
                                              std::move(joints));
           }});
    }
  }
  scenes.push_back({"closed", [](const StepperOptions& options) {
                      Rods rods;
                      std::vector<Vector3d> ring;
                      for (int i = 0; i <= 24; ++i) {
                        const double angle = 2.0 * M_PI * (i % 24) / 24.0;
                        ring.emplace_back(0.1 * std::cos(angle), 0.1 * std::sin(angle), 0.0);
                      }
                      rods.add(ring, 0.005, rubber(0.005));
                      auto joints = std::make_unique<Joints>(Joints::Options{});
                      joints->close(rods, 0);
                      return std::make_unique<Stepper>(std::move(rods), elastic(standard_gravity),
                                                       options, nullptr, std::move(joints));
                    }});
  return scenes;
}

/// Rods on the ground, on each other, and on what moves: they settle first.
std::vector<SteadyScene> scenes_of_contacts() {
  constexpr int settling = 600;
  const auto on = [](const std::function<std::unique_ptr<Contacts>()>& make_contacts) {
    return [=](const StepperOptions& options) {
      Rods rods;
      for (const double height : {0.005, 0.015}) {
        const Vector3d middle(0.0, 0.0, height);
        const Vector3d half = 0.25 * (height < 0.01 ? Vector3d::UnitX() : Vector3d::UnitY());
        rods.add(straight(middle - half, middle + half, 20), 0.005, rubber(0.005));
      }
      Effects effects = elastic(standard_gravity);
      effects.push_back(std::make_unique<Damping>(0.05));
      return std::make_unique<Stepper>(std::move(rods), std::move(effects), options,
                                       make_contacts());
    };
  };
  std::vector<SteadyScene> scenes;
  for (const bool has_friction : {false, true}) {
    const std::optional<double> friction = has_friction ? std::optional<double>(0.3) : std::nullopt;
    const std::string how = has_friction ? ", with friction" : "";
    scenes.push_back({"on the ground" + how,
                      on([=] { return contacts_with(environment_of(HalfSpaceShape{}), friction); }),
                      settling});
    scenes.push_back({"on a lift" + how, on([=] {
                        return contacts_with_moving(
                            {going(BoxShape{{1.0, 1.0, 0.2}}, {0, 0, -0.1}, {0.01, 0.0, 0.05})},
                            friction);
                      }),
                      settling});
  }
  // One triangle, so that its contacts are always the same ones.
  const auto sheet = std::make_shared<const TriangleMesh>(
      std::vector<Vector3d>{{-2.0, -1.0, 0.0}, {2.0, -1.0, 0.0}, {0.0, 2.0, 0.0}},
      std::vector<TriangleMesh::Triangle>{{0, 1, 2}});
  scenes.push_back(
      {"on a mesh", on([=] { return contacts_with(environment_of(sheet), 0.3); }), settling});
  scenes.push_back({"on a mesh that moves", on([=] {
                      return contacts_with_moving({going(sheet, {0, 0, 0}, {0.0, 0.0, 0.02})}, 0.3);
                    }),
                    settling});
  scenes.push_back(
      {"far from what moves", on([] {
         return contacts_with_moving({going(SphereShape{0.1}, {0.0, 0.0, 3.0}, {1.0, 0.0, 1.0})});
       }),
       200});
  return scenes;
}

/// Memory for a step is that of the step before.
TEST(StepAllocation, IsNone) {
  std::vector<SteadyScene> all = scenes_of_effects();
  for (const auto& more : {scenes_of_joints(), scenes_of_contacts()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  for (const SteadyScene& scene : all) {
    for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
      StepperOptions options = one_thread();
      options.integrator = integrator;
      const std::unique_ptr<Stepper> stepper = scene.make(options);
      const auto run = [&](int steps) {
        for (int i = 0; i < steps; ++i) {
          stepper->step(step);
        }
      };
      run(scene.settling);
      EXPECT_EQ(memory_of([&] { run(20); }).allocations, 0U)
          << scene.name << ", " << (integrator == Integrator::BDF2 ? "BDF2" : "implicit Euler");
    }
  }
}

}  // namespace
}  // namespace fiber::test

// Scenes that are copied as they run, and what is told of the time to come.
#include "fiber_proximity/sim/scene/prediction.hpp"

#include <algorithm>

#include "src/sim/scene/prediction_observer.hpp"
#include "test/sim/scene/scene_fixture.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

/// Two cables that are dragged over a table and each other, with all that scenes may name.
std::string busy_scene(const std::string& more_effects, const std::string& integrator) {
  return "fibers:\n"
         "  - {name: upper, shape: {line: {from: [0, -0.1, 0.017], to: [0, 0.5, 0.017]}}, "
         "segments: "
         "20, radius: 0.005, material: power_cable}\n"
         "  - {name: lower, shape: {line: {from: [-0.3, 0.1, 0.006], to: [0.3, 0.1, 0.006]}}, "
         "segments: 20, radius: 0.005, material: power_cable}\n"
         "effects: [gravity, bend, damping, self_contact, fiber_contact, environment_contact, "
         "friction, " +
         more_effects +
         ", {attachment: [{fiber: upper, kind: clamp, path: [{time: 0}, {time: 1, position: [0.3, "
         "-0.1, 0.017]}]}]}]\n"
         "environment: {obstacles: [{id: table, primitives: [{type: box, dimensions: [4, 4, "
         "0.1]}], "
         "pose: {position: [0, 0, -0.05]}}]}\n"
         "integrator: " +
         integrator + "\n";
}

void advance(SimScene& scene, int frames) {
  for (int i = 0; i < frames; ++i) {
    scene.advance();
  }
}

void expect_same_state(const SimScene& x, const SimScene& y) {
  const Rods& a = x.stepper->rods();
  const Rods& b = y.stepper->rods();
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.velocities, b.velocities);
  EXPECT_EQ(a.angles, b.angles);
  EXPECT_EQ(a.spins, b.spins);
  EXPECT_EQ(a.natural_curvatures, b.natural_curvatures);
  EXPECT_EQ(x.stepper->time(), y.stepper->time());
}

/// Moves from one place to another.
HoldTrajectory trajectory_to(const Vector3d& place, double time, std::uint32_t node = 0) {
  return {0, node, {{time, {place, Vector3d::UnitY(), Vector3d::UnitZ()}}}};
}

class PredictionTest : public SimSceneTest {
 protected:
  /// A cable that hangs from where it is held, over a floor 1.2 m below.
  static std::string hanging(const std::string& more_effects = "") {
    return "fibers:\n"
           "  - {name: cable, shape: {line: {from: [0, 0, 0], to: [0.1, 0, -0.99]}}, segments: 10, "
           "radius: 0.01, material: rope}\n"
           "effects: [gravity, stretch, bend, damping, environment_contact, friction, {attachment: "
           "[{fiber: cable}]}" +
           more_effects +
           "]\n"
           "environment: {obstacles: [{id: floor, primitives: [{type: box, dimensions: [2, 2, "
           "0.1]}], pose: {position: [0, 0, -1.25]}}]}\n";
  }
};

TEST_F(PredictionTest, ACopyGoesOnBitForBit) {
  for (const char* effects : {"stretch", "inextensible", "stretch, twist", "stretch, plasticity"}) {
    for (const char* integrator : {"implicit_euler", "bdf2"}) {
      SCOPED_TRACE(std::string(effects) + ", " + integrator);
      const SimDescription description = describe(busy_scene(effects, integrator));
      SimScene scene = make_sim_scene(description, 2);
      advance(scene, 20);
      SimScene untouched = make_sim_scene(description, 2);
      advance(untouched, 20);
      SimScene copy = copy_sim_scene(description, scene, 1);
      expect_same_state(copy, scene);
      advance(copy, 10);
      expect_same_state(untouched, scene);
      advance(scene, 10);
      advance(untouched, 10);
      expect_same_state(copy, scene);
      expect_same_state(untouched, scene);
      const auto contacts = scene.stepper->forces().contacts;
      EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(), [](const auto& contact) {
        return contact.other_rod != RodForces::ContactForce::obstacle;
      })) << "they touch each other";
      EXPECT_GT((scene.stepper->rods().positions[20] - description.rods.positions[20]).norm(), 0.02)
          << "it has moved";
    }
  }
}

TEST_F(PredictionTest, ACopyOfJoinedFibersGoesOnBitForBit) {
  const std::string effects =
      "[gravity, stretch, bend, twist, damping, {attachment: [{fiber: cable, kind: clamp}]}, "
      "{joint: [{kind: weld, nodes: [{fiber: cable, node: last}, {fiber: ring}]}]}]";
  std::string text = scene_text(line, effects, "integrator: bdf2\n");
  text.insert(text.find("effects:"),
              "  - {name: ring, shape: {polyline: [[1, 0, 0], [1.2, 0, 0.1], [1.4, 0, 0], [1.2, 0, "
              "-0.1]]}, closed: true, segments: 12, radius: 0.01, material: rope}\n");
  const SimDescription description = describe(text);
  SimScene scene = make_sim_scene(description, 1);
  advance(scene, 15);
  SimScene copy = copy_sim_scene(description, scene, 1);
  advance(scene, 15);
  advance(copy, 15);
  expect_same_state(copy, scene);
  EXPECT_FALSE(scene.stepper->forces().joints.empty());
}

TEST_F(PredictionTest, ACopyHasTheParametersAndHoldsOfNow) {
  const SimDescription description = describe(hanging());
  SimScene scene = make_sim_scene(description, 1);
  scene.parameters.set({{"gravity.acceleration", {1.0, 0.0, -9.0}}});
  follow(scene, {trajectory_to({0.2, 0, 0}, 0.5), trajectory_to({0.1, 0, -1}, 1.0, 10)});
  advance(scene, 10);
  SimScene copy = copy_sim_scene(description, scene, 1);
  EXPECT_EQ(copy.parameters.all().size(), scene.parameters.all().size());
  follow(scene, {trajectory_to({0, 0.3, 0}, 1.0)});  // of which the copy knows nothing
  advance(scene, 1);
  advance(copy, 40);
  SimScene again = make_sim_scene(description, 1);
  again.parameters.set({{"gravity.acceleration", {1.0, 0.0, -9.0}}});
  follow(again, {trajectory_to({0.2, 0, 0}, 0.5), trajectory_to({0.1, 0, -1}, 1.0, 10)});
  advance(again, 50);
  expect_same_state(copy, again);
}

TEST_F(PredictionTest, TellsWhatComesWhenItComes) {
  const SimDescription description = describe(busy_scene("stretch", "implicit_euler"));
  SimScene scene = make_sim_scene(description, 1);
  advance(scene, 10);
  const std::vector<HoldTrajectory> trajectories{trajectory_to({-0.2, -0.1, 0.1}, 0.5)};
  PredictionOptions options;
  options.duration = 1.0;
  options.sample_period = 0.25;
  SimScene copy = copy_sim_scene(description, scene, 1);
  follow(copy, trajectories);
  const Prediction told = predict(copy, options);
  EXPECT_EQ(told.problem, "");
  EXPECT_NEAR(told.time, 1.0, 1e-9);
  ASSERT_EQ(told.samples.size(), 5U);
  follow(scene, trajectories);
  double nearest = 1.0;
  for (int frame = 0; frame <= 60; ++frame) {
    if (frame % 15 == 0) {
      const Prediction::Sample& sample = told.samples[static_cast<std::size_t>(frame / 15)];
      EXPECT_EQ(sample.positions, scene.stepper->rods().positions);
      EXPECT_NEAR(sample.time, frame / 60.0, 1e-9);
    }
    const Rods& rods = scene.stepper->rods();
    QueryResult result;
    scene.environment->query(FiberAssembly(rods.positions, rods.offsets, rods.radii), {}, {},
                             result);
    for (const Contact& contact : result.contacts) {
      nearest = contact.fiber_a == 0 ? std::min(nearest, contact.distance) : nearest;
    }
    scene.advance();
  }
  const auto least =
      std::find_if(told.clearances.begin(), told.clearances.end(),
                   [](const auto& each) { return each.is_object && each.contact.fiber_a == 0; });
  ASSERT_NE(least, told.clearances.end());
  if (nearest <= 0.0) {
    EXPECT_EQ(least->contact.distance, nearest);
  }
}

TEST_F(PredictionTest, ForcesAreThoseOfStatics) {
  const SimDescription description = describe(hanging());
  SimScene scene = make_sim_scene(description, 1);
  const Rods& rods = scene.stepper->rods();
  double weight = 0.0;
  for (const double mass : rods.masses) {
    weight += 9.81 * mass;
  }
  // Slowly down to where the lower part of the cable lies on the floor.
  PredictionOptions options;
  options.duration = 6.0;
  follow(scene, {trajectory_to({0, 0, -0.5}, 4.0)});
  const Prediction told = predict(scene, options);
  ASSERT_EQ(told.problem, "");
  ASSERT_EQ(told.samples.size(), 1U) << "the end alone";
  ASSERT_EQ(told.holds.size(), 1U);
  EXPECT_EQ(told.holds[0].node, 0U);
  EXPECT_NEAR(told.holds[0].force, weight, 0.15 * weight) << "it swings a little";
  ASSERT_EQ(told.tensions.size(), 1U);
  EXPECT_EQ(told.tensions[0].node, 0U) << "the uppermost edge";
  EXPECT_NEAR(told.tensions[0].force, weight, 0.15 * weight);
  ASSERT_EQ(told.touches.size(), 1U);
  EXPECT_TRUE(told.touches[0].is_object);
  EXPECT_GT(told.touches[0].first, 1.0) << "it is 0.2 m above the floor, and moves at 0.125 m/s";
  EXPECT_LT(told.touches[0].first, 2.0);
  EXPECT_EQ(told.touches[0].last, told.time);
  EXPECT_GT(told.touches[0].max_force, 0.1 * weight);
  EXPECT_LT(told.touches[0].max_force, 2.0 * weight);
  ASSERT_EQ(told.clearances.size(), 1U);
  EXPECT_NEAR(told.clearances[0].contact.distance, 0.0, 0.001);
}

/// A branch that hangs from the end of a cable pulls at their joint by its weight, swinging a
/// little more; each node feels as much.
TEST_F(PredictionTest, TheGreatestForcesOfJointsAreTold) {
  const SimDescription description = describe(
      "fibers:\n"
      "  - {name: cable, shape: {line: {from: [0, 0, 0], to: [0, 0, -0.5]}}, segments: 10, radius: "
      "0.005, material: power_cable}\n"
      "  - {name: branch, shape: {line: {from: [0, 0, -0.5], to: [0, 0, -0.8]}}, segments: 6, "
      "radius: 0.005, material: power_cable}\n"
      "effects: [gravity, stretch, bend, damping, {joint: [{nodes: [{fiber: cable, node: last}, "
      "{fiber: branch}]}]}, {attachment: [{fiber: cable}]}]\n");
  SimScene scene = make_sim_scene(description, 1);
  const Rods& rods = scene.stepper->rods();
  double weight = 0.0;
  for (std::uint32_t i = rods.first(1); i < rods.end(1); ++i) {
    weight += 9.81 * rods.masses[i];
  }
  PredictionOptions options;
  options.duration = 2.0;
  follow(scene, {trajectory_to({0.05, 0, 0}, 1.0)});
  const Prediction told = predict(scene, options);
  ASSERT_EQ(told.joints.size(), 2U);
  EXPECT_EQ(told.joints[0].rod, 0U);
  EXPECT_EQ(told.joints[0].node, 10U);
  EXPECT_EQ(told.joints[1].rod, 1U);
  EXPECT_EQ(told.joints[1].node, 0U);
  EXPECT_GT(told.joints[0].force, weight);
  EXPECT_LT(told.joints[0].force, 1.5 * weight);
  EXPECT_NEAR(told.joints[1].force, told.joints[0].force, 1e-6 * weight);
  EXPECT_NE(summary(told, scene, 0.1).find("joint: at most "), std::string::npos);
}

TEST_F(PredictionTest, WhatMayNotBeAskedIsRefusedAndChangesNothing) {
  const SimDescription description = describe(hanging());
  SimScene scene = make_sim_scene(description, 1);
  const auto error = [&](const HoldTrajectory& trajectory) {
    return error_of([&] { follow(scene, {trajectory_to({0, 0, 0.1}, 1.0, 3), trajectory}); });
  };
  EXPECT_EQ(error({0, 0, {}}), "trajectory 1: it has no entries");
  EXPECT_EQ(error({7, 0, {}}), "trajectory 1: there is no fibre 7");
  EXPECT_EQ(error(trajectory_to({0, 0, 0}, 1.0, 11)),
            "trajectory 1: fibre 'cable' has 11 nodes, there is no node 11");
  EXPECT_EQ(error(trajectory_to({0, 0, 0}, 1.0, 3)),
            "trajectory 1: node 3 of fibre 'cable' has another one already");
  EXPECT_EQ(error(trajectory_to({0, 0, 0}, -1.0)),
            "trajectory 1: entry 0: time is -1 s, times must be finite and rise from 0");
  HoldTrajectory falls = trajectory_to({0, 0, 0}, 1.0);
  falls.path.push_back(falls.path.front());
  EXPECT_EQ(error(falls),
            "trajectory 1: entry 1: time is 1 s, times must be finite and rise from 0, the one "
            "before is 1 s");
  EXPECT_EQ(error(trajectory_to({0, 0, std::nan("")}, 1.0)),
            "trajectory 1: entry 0: position must be finite, tangent and director of unit length, "
            "across each other");
  EXPECT_NE(error(trajectory_to({0, 0, 5}, 0.0)).find("it begins 5 m from where"),
            std::string::npos);
  // By more than an edge, however stiff it is.
  const double edge = scene.stepper->rods().rest_lengths[0];
  EXPECT_NE(error(trajectory_to({0, 0, 1.1 * edge}, 0.0)).find("m from where the node is held"),
            std::string::npos);
  EXPECT_EQ(error(trajectory_to({0, 0, 5000}, 1.0)),
            "trajectory 1: entry 0: it goes 5e+03 m in 1 s, at most 1e+03 m/s are allowed");
  EXPECT_FALSE(scene.attachment->find(0, 3).has_value()) << "the first one was not taken";
  PredictionOptions options;
  options.duration = 0.0;
  EXPECT_EQ(error_of([&] { predict(scene, options); }),
            "duration is 0 s, it must be more than 0 and at most 3.6e+03");
  options = {};
  options.margin = -1.0;
  EXPECT_EQ(error_of([&] { predict(scene, options); }),
            "margin is -1 m, it must be finite and at least 0");
  EXPECT_EQ(scene.stepper->time(), 0.0);
}

TEST_F(PredictionTest, ObstaclesGoTheirWayAsWell) {
  std::string text = hanging();
  text.insert(text.rfind(']'),
              ", {id: pusher, motion: {path: [{time: 0}]}, pose: {position: [0.4, 0, -0.8]}, "
              "primitives: [{type: sphere, dimensions: [0.1]}]}");
  const SimDescription description = describe(text);
  SimScene scene = make_sim_scene(description, 1);
  advance(scene, 5);
  const auto way = [](double x, double time) {
    return ObstacleTrajectory{0, {{time, Eigen::Isometry3d(Eigen::Translation3d(x, 0.0, -0.8))}}};
  };
  PredictionOptions options;
  const auto touches = [&](const std::vector<ObstacleTrajectory>& ways) {
    SimScene copy = copy_sim_scene(description, scene, 1);
    follow(copy, ways);
    const Prediction told = predict(copy, options);
    EXPECT_EQ(told.problem, "");
    return told.touches.size();
  };
  EXPECT_EQ(touches({}), 0U);
  EXPECT_EQ(touches({way(0.0, 0.5)}), 1U);
  EXPECT_EQ(scene.motions()->poses()[0].translation().x(), 0.4);
  const auto error = [&](const std::vector<ObstacleTrajectory>& ways) {
    SimScene copy = copy_sim_scene(description, scene, 1);
    return error_of([&] { follow(copy, ways); });
  };
  EXPECT_EQ(error({{3, {}}}), "trajectory 0: there is no obstacle 3 that moves");
  EXPECT_EQ(error({{0, {}}}), "trajectory 0: it has no entries");
  EXPECT_EQ(error({way(0.0, 0.5), way(0.0, 0.5)}),
            "trajectory 1: obstacle 'pusher' has another one already");
  EXPECT_EQ(error({way(5000.4, 1.0)}),
            "trajectory 0: entry 0: it goes 5e+03 m in 1 s, at most 1e+03 m/s are allowed");
  EXPECT_EQ(error({way(0.0, 0.0)}),
            "trajectory 0: entry 0: it begins 0.4 m from where the obstacle is, at time 0; 0.001 m "
            "are allowed");
}

/// However small the period is.
TEST_F(PredictionTest, SamplesAreOfWholeFrames) {
  const SimDescription description = describe(hanging());
  for (const double period : {1e-300, 1e-15, 1e-3, 1.0 / 60.0}) {
    SimScene scene = make_sim_scene(description, 1);
    PredictionOptions options;
    options.duration = 0.1;
    options.sample_period = period;
    EXPECT_EQ(predict(scene, options).samples.size(), 7U) << period;
  }
}

TEST_F(PredictionTest, WhatIsCancelledTellsHowFarItCame) {
  const SimDescription description = describe(hanging());
  SimScene scene = make_sim_scene(description, 1);
  int asked = 0;
  const Prediction told = predict(scene, {}, [&asked] { return ++asked > 6; });
  EXPECT_EQ(told.problem, "it was cancelled");
  EXPECT_NEAR(told.time, 0.1, 1e-9);
}

}  // namespace
}  // namespace fiber

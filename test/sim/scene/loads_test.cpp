// Loads, gravity in time and velocities to begin with, as scenes have them.

#include <fstream>

#include "src/sim/scene/force_file.hpp"
#include "test/sim/scene/scene_fixture.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

std::string with_loads(const std::string& loads, const std::string& effects = "stretch, bend") {
  return scene_text(line, "[" + effects + ", {load: [" + loads + "]}]");
}

Vector3d momentum_in(const SimScene& scene) {
  const Rods& rods = scene.stepper->rods();
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < rods.masses.size(); ++i) {
    sum += rods.masses[i] * rods.velocities[i];
  }
  return sum;
}

TEST_F(SimSceneTest, LoadsAreAtNodesAndAlongParts) {
  SimScene scene = read(with_loads(
      "{fiber: cable, node: last, force: [1, 0, 0], mass: 2}, "
      "{fiber: cable, from: 0.3, force: [0, 2, 0]}, "
      "{fiber: cable, node: 1, table: [{time: 0}, {time: 0.1, force: [0, 0, 1]}], period: 0.2}"));
  const SimScene bare = read(scene_text(line, "[stretch, bend]"));
  EXPECT_NEAR(scene.stepper->rods().masses[4] - bare.stepper->rods().masses[4], 2.0, 1e-12);
  scene.stepper->step(0.05);
  EXPECT_LE((momentum_in(scene) - 0.05 * Vector3d(1.0, 1.4, 0.5)).norm(), 1e-9);
  for (int i = 0; i < 5; ++i) {
    scene.stepper->step(0.05);
  }
  EXPECT_LE((momentum_in(scene) - Vector3d(0.3, 0.42, 0.05 * 3.5)).norm(), 1e-9);
}

TEST_F(SimSceneTest, ConstantLoadsAreParameters) {
  SimScene scene = read(
      "fibers:\n"
      "  - {name: hair, shape: {line: {from: [0, 0, 0], to: [1, 0, 0]}}, segments: 2, radius: 1e-3,"
      " material: hair, repeat: {count: 2, offset: [0, 1, 0]}}\n"
      "effects: [stretch, bend, twist, {load: [{fiber: hair_0, node: 0, mass: 1}, {fiber: hair, "
      "node: last, force: [1, 0, 0], moment: [0, 0, 1], torque: 2}]}]\n");
  const auto names = [&] {
    std::vector<std::string> all;
    for (const SimParameter& each : scene.parameters.all()) {
      all.push_back(each.name);
    }
    return all;
  };
  EXPECT_EQ(names(), (std::vector<std::string>{"load.1.force", "load.1.moment", "load.1.torque"}));
  scene.parameters.set({{"load.1.force", {0.0, 3.0, 0.0}}, {"load.1.moment", {0.0, 0.0, 0.0}}});
  scene.stepper->step(1e-3);
  EXPECT_LE((momentum_in(scene) - 1e-3 * Vector3d(0.0, 6.0, 0.0)).norm(), 1e-9);
  EXPECT_EQ(error_of([&] {
              scene.parameters.set({{"load.0.mass", {1.0}}});
            }),
            "parameter 'load.0.mass' is [1.000000]: there is no such parameter, known are: "
            "load.1.force, load.1.moment, load.1.torque");
}

TEST_F(SimSceneTest, ForcesOfLoadsAreWritten) {
  SimScene scene = read(with_loads("{fiber: cable, node: 2, force: [1, 2, 3]}"));
  scene.stepper->step(0.01);
  const std::string file = folder_.path("forces.csv");
  ForceWriter writer(file);
  writer.write(0, scene.stepper->rods(), scene.stepper->forces());
  writer.finish();
  std::stringstream text;
  text << std::ifstream(file).rdbuf();
  EXPECT_NE(text.str().find("\n0,load,0,2,1,2,3,0,0,0\n"), std::string::npos) << text.str();
}

TEST_F(SimSceneTest, GravityChangesInTime) {
  SimScene scene =
      read(scene_text(line,
                      "[stretch, {gravity: {acceleration: [0, 0, -1], table: [{time: 0}, {time: 1, "
                      "acceleration: [0, 2, 0]}], period: 2}}]"));
  EXPECT_TRUE(scene.parameters.all().empty()) << "what changes in time is no parameter";
  scene.stepper->step(0.5);
  EXPECT_LE((scene.stepper->rods().velocities[1] - Vector3d(0.0, 0.5, -0.25)).norm(), 1e-9);
  scene.stepper->step(1.5);
  EXPECT_LE((scene.stepper->rods().velocities[1] - Vector3d(0.0, 0.5, -1.75)).norm(), 1e-9);
}

/// Wherever a fibre's nodes are: the first half is one segment here.
TEST_F(SimSceneTest, VelocitiesAreAtEqualDistancesAlongAFibre) {
  std::string text = scene_text(line, "[stretch, bend]", "time_step: 0.001\n");
  text.replace(text.find("    segments: 4"), 15,
               "    segments: 6\n    velocities: [[0, 0, 0], [0, 0, 1]]\n"
               "    sections: [{from: 0, to: 0.5, rigid: true}]");
  const SimScene scene = read(text);
  const Rods& rods = scene.stepper->rods();
  for (std::uint32_t i = 0; i < rods.end(0); ++i) {
    EXPECT_NEAR(rods.velocities[i].z(), rods.positions[i].x(), 1e-12) << i;
  }
  EXPECT_NEAR(rods.positions[1].x(), 0.5, 1e-12);
}

/// A rod of 1 m that is thrown with a spin about an axis across it and one about its own.
TEST_F(SimSceneTest, AThrownFibreFliesItsParabolaAndKeepsItsSpin) {
  const auto thrown = [&](const std::string& integrator) {
    std::string text =
        scene_text("{line: {from: [0, 0, 0], to: [1, 0, 0]}}", "[gravity, stretch, bend, twist]",
                   "residual: 1e-9\nintegrator: " + integrator + "\n");
    text.replace(text.find("    segments: 4"), 15,
                 "    segments: 4\n    velocity: [1, 0, 3]\n    angular_velocity: [5, 2, 0]");
    return read(text);
  };
  SimScene scene = thrown("bdf2");
  const Rods& rods = scene.stepper->rods();
  EXPECT_LE((rods.velocities[0] - Vector3d(1.0, 0.0, 3.0 + 1.0)).norm(), 1e-12);
  EXPECT_LE((rods.velocities[2] - Vector3d(1.0, 0.0, 3.0)).norm(), 1e-12);
  EXPECT_NEAR(rods.spins[0], 5.0, 1e-12);
  EXPECT_EQ(rods.spins[4], 0.0);
  const auto total = [](const Rods& r) {
    double mass = 0.0;
    Vector3d center = Vector3d::Zero();
    for (std::size_t i = 0; i < r.masses.size(); ++i) {
      mass += r.masses[i];
      center += r.masses[i] * r.positions[i];
    }
    return std::make_pair(mass, Vector3d(center / mass));
  };
  const auto spin = [&](const Rods& r) {
    const auto [mass, center] = total(r);
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < r.masses.size(); ++i) {
      sum += r.masses[i] * (r.positions[i] - center).cross(r.velocities[i]);
    }
    return sum;
  };
  const double mass = total(rods).first;
  const double begins = spin(rods).y();
  for (int i = 0; i < 200; ++i) {
    scene.stepper->step(0.001);
    const double t = scene.stepper->time();
    const Vector3d expected = mass * Vector3d(1.0, 0.0, 3.0 - 9.81 * t);
    ASSERT_LE((momentum_in(scene) - expected).norm(), 1e-12 * mass * 3.0 + 1e-12);
  }
  const double t = scene.stepper->time();
  EXPECT_LE((total(rods).second - Vector3d(0.5 + t, 0.0, 3.0 * t - 0.5 * 9.81 * t * t)).norm(),
            1e-6);
  EXPECT_NEAR(spin(rods).y(), begins, 1e-3 * std::abs(begins));
  // Implicit Euler loses part of it: half of what it turns in a step, each step.
  SimScene euler = thrown("implicit_euler");
  for (int i = 0; i < 200; ++i) {
    euler.stepper->step(0.001);
  }
  EXPECT_LT(std::abs(spin(euler.stepper->rods()).y()), std::abs(begins));
  EXPECT_NEAR(spin(euler.stepper->rods()).y(), begins, 0.01 * std::abs(begins));
}

TEST_F(SimSceneTest, VelocitiesAreAlongTheFibre) {
  std::string text = scene_text(line, "[stretch]");
  text.replace(text.find("    segments: 4"), 15,
               "    segments: 4\n    velocities: [[0, 0, 0], [0, 1, 0], [2, 1, 0]]");
  const SimScene scene = read(text);
  const std::vector<Vector3d>& velocities = scene.stepper->rods().velocities;
  EXPECT_EQ(velocities[0], Vector3d(0.0, 0.0, 0.0));
  EXPECT_EQ(velocities[1], Vector3d(0.0, 0.5, 0.0));
  EXPECT_EQ(velocities[2], Vector3d(0.0, 1.0, 0.0));
  EXPECT_EQ(velocities[4], Vector3d(2.0, 1.0, 0.0));
}

TEST_F(SimSceneTest, LoadsThatCannotBeAreErrors) {
  const std::vector<std::pair<std::string, std::string>> refused{
      {"{fiber: rope, node: 0, mass: 1}",
       "7: effects[2].load[0].fiber is rope, it must be the name of a fibre of the scene: cable"},
      {"{fiber: cable, node: 5, mass: 1}",
       "7: effects[2].load[0].node is 5, it must be a whole number from 0 to 4 (fibre 'cable')"},
      {"{fiber: cable, mass: 1}",
       "7: effects[2].load[0] says not where it is, it must have a node, or from and to (fibre "
       "'cable')"},
      {"{fiber: cable, node: 0, from: 0, mass: 1}",
       "7: effects[2].load[0].node is 0, it must be absent where there is a part, from and to "
       "(fibre 'cable')"},
      {"{fiber: cable, node: 0}",
       "7: effects[2].load[0] does nothing, it must have a force, moment, torque, mass or table "
       "(fibre 'cable')"},
      {"{fiber: cable, to: 1.1, mass: 1}",
       "7: effects[2].load[0].to is 1.1, it must be beyond `from` and at most the fibre's "
       "length, "
       "1 m (fibre 'cable')"},
      {"{fiber: cable, from: 1, mass: 1}",
       "7: effects[2].load[0].from is 1, it must be at least 0 and less than the fibre's length, "
       "1 m (fibre 'cable')"},
      {"{fiber: cable, from: 0.5, to: 0.4, mass: 1}",
       "7: effects[2].load[0].to is 0.4, it must be beyond `from` and at most the fibre's "
       "length, "
       "1 m (fibre 'cable')"},
      {"{fiber: cable, node: 0, mass: -1}",
       "7: effects[2].load[0].mass is -1, it must be at least 0 (fibre 'cable')"},
      {"{fiber: cable, node: 0, force: [0, .nan, 0]}",
       "7: effects[2].load[0].force is [0, .nan, 0], it must be finite (fibre 'cable')"},
      {"{fiber: cable, node: 0, torque: 1}",
       "7: effects[2].load[0].torque is 1, it must be absent where there is no twist: "
       "cross-sections that turn freely resist none (fibre 'cable')"},
      {"{fiber: cable, node: 2, moment: [0, 0, 1]}",
       "7: effects[2].load[0].moment is [0, 0, 1], it must be absent but at the first or last "
       "node: in between there is only a torque, with twist (fibre 'cable')"},
      {"{fiber: cable, node: 0, table: [{time: 0}, {time: 0}]}",
       "7: effects[2].load[0].table[1].time is 0, it must be later than the time before, "
       "0.000000 "
       "s (fibre 'cable')"},
      {"{fiber: cable, node: 0, table: [{time: 1}]}",
       "7: effects[2].load[0].table[0].time is 1, it must be 0, where the table begins (fibre "
       "'cable')"},
      {"{fiber: cable, node: 0, table: [{time: 0}, {time: 1}], period: 1}",
       "7: effects[2].load[0].period is 1, it must be longer than the table, 1.000000 s: it "
       "leads "
       "back to its beginning (fibre 'cable')"},
      {"{fiber: cable, node: 0, force: [0, 0, 1], period: 1}",
       "7: effects[2].load[0].period is 1, it must be absent where there is no table (fibre "
       "'cable')"},
  };
  for (const auto& [load, expected] : refused) {
    EXPECT_EQ(error(with_loads(load)), expected) << load;
  }
}

TEST_F(SimSceneTest, VelocitiesThatCannotBeAreErrors) {
  const std::vector<std::pair<std::string, std::string>> refused{
      {"velocity: [0, 0, 1001]",
       "4: fibers[0].velocity is [0, 0, 1001], it must be finite and at most 1000 m/s (fibre "
       "'cable')"},
      {"velocities: [[0, 0, 1]]",
       "4: fibers[0].velocities is [[0, 0, 1]], it must be a list of at least two velocities "
       "(fibre 'cable')"},
      {"angular_velocity: [0, 3000, 0]",
       "2: fibers[0]: point 0 begins with 1500.000000 m/s, it must be at most 1000 m/s (fibre "
       "'cable')"},
      {"angular_velocity: [1e6, 0, 0]",
       "2: fibers[0]: its surface begins with 10000.000000 m/s about its axis, it must be at most "
       "1000 m/s (fibre 'cable')"},
      {"angular_velocity: [0, .inf, 0]",
       "4: fibers[0].angular_velocity is [0, .inf, 0], it must be finite (fibre 'cable')"},
  };
  for (const auto& [key, expected] : refused) {
    std::string text = scene_text(line, "[stretch]");
    text.replace(text.find("    segments: 4"), 15, "    " + key + "\n    segments: 4");
    EXPECT_EQ(error(text), expected) << key;
  }
}

}  // namespace
}  // namespace fiber

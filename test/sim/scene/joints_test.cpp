// Joints and closed fibres, as scenes have them.

#include <fstream>

#include "src/sim/scene/force_file.hpp"
#include "src/sim/scene/reach.hpp"
#include "test/sim/scene/scene_fixture.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

constexpr const char* joined_pair =
    "fibers:\n"
    "  - {name: stem, shape: {line: {from: [0, 0, 0], to: [1, 0, 0]}}, segments: 10,"
    " radius: 0.01, material: silicone_tube}\n"
    "  - {name: branch, shape: {line: {from: [0.5, 0, 0], to: [0.5, 0.4, 0]}}, segments: 5,"
    " radius: 0.01, material: silicone_tube}\n";

std::string joined(const std::string& joints, const std::string& others = "stretch, bend") {
  return joined_pair + ("effects: [" + others + ", {joint: [" + joints + "]}]\n");
}

constexpr const char* branching = "{kind: weld, nodes: [{fiber: stem, node: 5}, {fiber: branch}]}";

std::string ring_of(const std::string& shape, const std::string& segments,
                    const std::string& effects) {
  return "fibers:\n  - {name: ring, closed: true, shape: " + shape + ", segments: " + segments +
         ", radius: 0.01, material: silicone_tube}\neffects: [" + effects + "]\n";
}

constexpr const char* square = "{polyline: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]}";

/// A rope that swings down onto the trunk from which it hangs: however both are numbered, what they
/// touch beside the joint holds them apart, and nothing else does.
TEST_F(SimSceneTest, JoinedFibersTouchWhicheverIsFirst) {
  const auto fiber = [](const std::string& name, const std::string& from, const std::string& to,
                        int segments) {
    return "  - {name: " + name + ", shape: {line: {from: " + from + ", to: " + to +
           "}}, segments: " + std::to_string(segments) + ", radius: 0.004, material: rope}\n";
  };
  for (const bool is_upwards : {false, true}) {
    for (const bool is_first : {false, true}) {
      SCOPED_TRACE(testing::Message() << is_upwards << is_first);
      const std::string top = "[0, 0, 1]";
      const std::string bottom = "[0, 0, 0.8]";
      const std::string trunk =
          fiber("trunk", is_upwards ? bottom : top, is_upwards ? top : bottom, 8);
      const std::string rope = fiber("rope", "[0, 0, 0.9]", "[0.6, 0, 0.9]", 16);
      SimScene scene =
          read("fibers:\n" + (is_first ? trunk + rope : rope + trunk) +
               "effects: [gravity, stretch, bend, fiber_contact, {joint: [{nodes: [{fiber: trunk, "
               "at: 0.5}, {fiber: rope}]}]}, {attachment: [{fiber: trunk}, {fiber: trunk, node: "
               "last}]}]\nsubsteps: 4\n");
      const std::uint32_t last = scene.stepper->rods().end(is_first ? 1 : 0) - 1;
      std::uint32_t unbalanced = 0;
      double lowest = 1.0;
      for (int i = 0; i < 90; ++i) {
        scene.advance();
        unbalanced += scene.frame.unbalanced;
        lowest = std::min(lowest, scene.stepper->rods().positions[last].z());
      }
      EXPECT_EQ(unbalanced, 0U);
      EXPECT_LT(lowest, 0.4) << "it hangs down";
      EXPECT_GT(scene.stepper->rods().velocities[last].norm(), 1e-6) << "it moves on";
    }
  }
}

/// The names of others are no shares of a fibre's own.
TEST_F(SimSceneTest, JointsAreOfTheFibersThatTheyName) {
  const auto fiber = [](const std::string& name, const std::string& y) {
    return "  - {name: " + name + ", shape: {line: {from: [0, " + y + ", 0], to: [1, " + y +
           ", 0]}}, segments: 5, radius: 0.004, material: rope}\n";
  };
  const SimScene scene = read(
      "fibers:\n" + fiber("branch", "0") + fiber("branch_1", "1") +
      "  - {name: twig, shape: {line: {from: [0.33, 1, 0], to: [0.33, 2, 0]}}, segments: 2, "
      "radius: 0.004, material: rope}\n"
      "effects: [stretch, {joint: [{nodes: [{fiber: branch_1, at: 0.33}, {fiber: twig}]}]}]\n");
  const Rods& rods = scene.stepper->rods();
  EXPECT_NEAR(rods.positions[2].x(), 0.4, 1e-12);
  EXPECT_NEAR(rods.positions[rods.first(1) + 2].x(), 0.33, 1e-12);
}

TEST_F(SimSceneTest, FibersAreJoined) {
  SimScene scene = read(joined(branching, "stretch, bend, gravity, self_contact, fiber_contact"));
  const Rods& rods = scene.stepper->rods();
  EXPECT_EQ(rods.joints[5], rods.joints[11]);
  scene.stepper->step(0.01);
  EXPECT_EQ(rods.positions[5], rods.positions[11]);
  const RodForces forces = scene.stepper->forces();
  ASSERT_EQ(forces.joints.size(), 2U);
  EXPECT_EQ(forces.joints[0].node, 5U);
  EXPECT_EQ(forces.joints[1].rod, 1U);
  const FiberTopology topology = assembly_of(rods).topology();
  EXPECT_TRUE(topology.closed.empty());
  ASSERT_EQ(topology.joints.size(), 17U);
  EXPECT_EQ(topology.joints[5], topology.joints[11]);
  EXPECT_LT(topology.joints[4], 0);
}

TEST_F(SimSceneTest, SharesOfTheLengthAreNodesHoweverManySegments) {
  for (const char* segments : {"segments: 10", "segments: 7", "segments: 3"}) {
    std::string text = joined("{nodes: [{fiber: stem, at: 0.5}, {fiber: branch, at: 0}]}");
    text.replace(text.find("segments: 10"), 12, segments);
    const SimScene scene = read(text);
    const Rods& rods = scene.stepper->rods();
    const std::uint32_t first = rods.first(1);
    ASSERT_GE(rods.joints[first], 0);
    EXPECT_LE((rods.positions[first] - Vector3d(0.5, 0.0, 0.0)).norm(), 1e-12);
    std::uint32_t met = 0;
    for (std::uint32_t i = 0; i < first; ++i) {
      met += rods.joints[i] == rods.joints[first] ? 1 : 0;
    }
    EXPECT_EQ(met, 1U);
  }
}

TEST_F(SimSceneTest, RepeatedFibersAreJoinedOneByOne) {
  const SimScene scene = read(
      "fibers:\n"
      "  - {name: a, shape: {line: {from: [0, 0, 0], to: [1, 0, 0]}}, segments: 4, radius: 0.01,"
      " material: hair, repeat: {count: 3, offset: [0, 1, 0]}}\n"
      "  - {name: b, shape: {line: {from: [1, 0, 0], to: [2, 0, 0]}}, segments: 4, radius: 0.01,"
      " material: hair, repeat: {count: 3, offset: [0, 1, 0]}}\n"
      "effects: [stretch, {joint: [{nodes: [{fiber: a, node: last}, {fiber: b}]}]}]\n");
  EXPECT_EQ(scene.stepper->joints()->joints().size(), 3U);
  EXPECT_EQ(scene.stepper->rods().joints[4], scene.stepper->rods().joints[15]);
}

TEST_F(SimSceneTest, FibersAreClosed) {
  SimScene scene = read(ring_of(square, "16", "stretch, bend, twist, self_contact"));
  const Rods& rods = scene.stepper->rods();
  EXPECT_TRUE(rods.is_closed(0));
  ASSERT_EQ(rods.node_count(0), 17U);
  EXPECT_NEAR(rods.rest_lengths[15], 0.25, 1e-12);
  scene.advance();
  EXPECT_EQ(rods.positions[0], rods.positions[16]);
  const FiberAssembly fibers = assembly_of(rods);
  EXPECT_TRUE(fibers.is_closed(0));
  EXPECT_EQ(fibers.given_points().size(), 16U);
  EXPECT_TRUE(fibers.topology().joints.empty());
}

TEST_F(SimSceneTest, HoldsReachThroughJoints) {
  SimScene scene = read(joined(branching, "stretch, bend, {attachment: [{fiber: stem}]}"));
  const NodeOfRod end = find_node(scene, 1, -1);
  EXPECT_NO_THROW(require_reach(scene, end, {0.5, 0.7, 0.0}, 0.1));
  EXPECT_EQ(
      error_of([&] {
        require_reach(scene, end, {0.5, 1.5, 0.0}, 0.1);
      }),
      "position (0.5, 1.5, 0) is 1.58 m from where node 0 of fibre 'stem' is held, with 0.9 m "
      "between: it reaches 0.99 m, stretched by 10 % (max_strain)");
}

TEST_F(SimSceneTest, ForcesOfJointsAreWritten) {
  SimScene scene = read(joined(branching, "stretch, bend, gravity"));
  scene.stepper->step(0.01);
  const auto file = std::filesystem::temp_directory_path() / "joint_forces.csv";
  ForceWriter writer(file.string());
  writer.write(1, scene.stepper->rods(), scene.stepper->forces());
  writer.finish();
  std::ifstream in(file);
  std::string row;
  std::vector<std::string> rows;
  while (std::getline(in, row)) {
    if (row.rfind("1,joint,", 0) == 0) {
      rows.push_back(row);
    }
  }
  std::filesystem::remove(file);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].rfind("1,joint,0,5,", 0), 0U) << rows[0];
  EXPECT_EQ(rows[1].rfind("1,joint,1,0,", 0), 0U) << rows[1];
}

TEST_F(SimSceneTest, WrongJointsAreErrors) {
  struct Case {
    std::string text;
    std::string error;
  };
  const std::string ends =
      "stretch, bend, {attachment: [{fiber: stem}, {fiber: branch, node: last, "
      "path: [{time: 0}, {time: 1, position: [0.5, 1.2, 0]}]}]}";
  const std::vector<Case> cases{
      {joined("{kind: hinge, nodes: [{fiber: stem}, {fiber: branch}]}"),
       "kind is hinge, it must be ball or weld"},
      {joined("{nodes: [{fiber: stem}]}"), "it must be a list of at least two nodes"},
      {joined("{nodes: [{fiber: stem}, {fiber: twig}]}"), "fiber is twig, it must be the name of"},
      {joined("{nodes: [{fiber: stem, node: 11}, {fiber: branch}]}"), "node is 11, it must be"},
      {joined("{nodes: [{fiber: stem, at: 1.5}, {fiber: branch}]}"),
       "at is 1.5, it must be at least 0 and at most 1"},
      {joined("{nodes: [{fiber: stem, at: 0.5, node: 5}, {fiber: branch}]}"),
       "it must be absent where there is a node"},
      {joined("{nodes: [{fiber: stem, node: 4}, {fiber: branch}]}"),
       "4: effects[2].joint[0]: node 0 of fibre 'branch' begins 0.1 m from node 4 of fibre 'stem', "
       "to which it is joined; it must begin within 0.01 m, the largest radius there"},
      {joined("{nodes: [{fiber: stem, node: 5}, {fiber: stem, node: 5}]}"),
       "node 5 of fibre 'stem' is there twice"},
      {joined("{nodes: [{fiber: stem, node: 5}, {fiber: stem, node: 4}]}"),
       "node 5 of fibre 'stem' and node 4 of fibre 'stem' are ends of one segment, which would "
       "have "
       "no length"},
      {ring_of(square, "16",
               "stretch, {joint: [{nodes: [{fiber: ring}, {fiber: ring, node: 15}]}]}"),
       "node 0 of fibre 'ring' and node 15 of fibre 'ring' are ends of one segment"},
      {joined(std::string(branching) + ", " + branching),
       "joint[1]: node 5 of fibre 'stem' is joined already: "},
      {joined(branching, "stretch"), "name the effect bend, too"},
      {joined(branching, ends),
       "joint[0]: at 1 s, what holds node 0 of fibre 'stem' at (0, 0, 0), node 5 of fibre 'branch' "
       "at (0.5, 1.2, 0) stretches the fibres between by 44.4"},
      {joined("{nodes: [{fiber: stem, at: 0.5}, {fiber: branch}]}, "
              "{nodes: [{fiber: stem, at: 0.51}, {fiber: branch, node: last}]}"),
       "its 10 segment(s) are too few for a joint or the end of a section at 0.51 beside one at "
       "0.5 of its length"},
      {joined_pair + std::string("effects: [stretch, joint]\n"), "a map of joint to a list"},
      {ring_of(square, "2", "stretch"), "segments is 2, it must be at least 3 of a closed fibre"},
      {ring_of("{line: {from: [0, 0, 0], to: [1, 0, 0]}}", "8", "stretch"),
       "closed is true, it must be absent or false where the shape is straight"},
      {ring_of(square, "16", "stretch, {attachment: [{fiber: ring, kind: clamp}]}"),
       "kind is clamp, it must be pin, or node must be an end of a fibre that is not closed"},
      {ring_of(square, "16", "stretch, {attachment: [{fiber: ring, node: 16}]}"), "node is 16"}};
  for (const Case& each : cases) {
    const std::string error = error_of([&] { read(each.text); });
    EXPECT_NE(error.find(each.error), std::string::npos) << error << "\nwithout\n" << each.error;
  }
}

}  // namespace
}  // namespace fiber

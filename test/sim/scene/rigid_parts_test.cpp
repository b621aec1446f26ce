// Plugs: parts of fibres in scenes that are rigid, thicker and heavier than the rest.
#include <cmath>

#include "test/sim/scene/scene_fixture.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

std::string with_parts(const std::string& sections, int segments = 5) {
  std::string text = scene_text(line, "[stretch, bend]");
  text.replace(text.find("    segments: 4"), 15,
               "    sections: [" + sections + "]\n    segments: " + std::to_string(segments));
  return text;
}

TEST_F(SimSceneTest, ARigidPartIsOneSegmentOfItsLength) {
  const Rods rods = read(with_parts("{from: 0.7, to: 0.9, radius: 0.02, rigid: true, material: "
                                    "{density: 1600}}"))
                        .stepper->rods();
  const std::vector<double> x{0.0, 0.7 / 3.0, 1.4 / 3.0, 0.7, 0.9, 1.0};
  ASSERT_EQ(rods.node_count(0), x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    EXPECT_NEAR(rods.positions[i].x(), x[i], 1e-12);
  }
  ASSERT_EQ(rods.mass_couplings.size(), x.size());
  for (std::uint32_t edge = 0; edge < x.size(); ++edge) {
    const double mass = 0.2 * 1600.0 * M_PI * 4e-4;
    EXPECT_NEAR(rods.mass_couplings[edge], edge == 3 ? mass / 6.0 : 0.0, 1e-12) << edge;
  }
  EXPECT_EQ(rods.edge_radius(0, 3), 0.02);
  EXPECT_EQ(rods.edge_radius(0, 4), 0.01);
  const double per_length = 800.0 * M_PI * 1e-4;
  EXPECT_NEAR(rods.masses[4], 0.5 * (0.1 * per_length + 0.2 * 8.0 * per_length), 1e-12);
}

TEST_F(SimSceneTest, PlugsAtBothEndsAreOneSegmentEach) {
  const Rods rods =
      read(with_parts("{to: 0.3, rigid: true}, {from: 0.75, rigid: true, radius: 0.03}"))
          .stepper->rods();
  EXPECT_NEAR(rods.positions[1].x(), 0.3, 1e-12);
  EXPECT_NEAR(rods.positions[2].x(), 0.45, 1e-12);
  EXPECT_NEAR(rods.positions[4].x(), 0.75, 1e-12);
  EXPECT_EQ(rods.edge_radius(0, 0), 0.01);
  EXPECT_EQ(rods.edge_radius(0, 4), 0.03);
}

TEST_F(SimSceneTest, APartWithARadiusOfItsOwnBeginsAndEndsAtNodes) {
  const Rods rods = read(with_parts("{from: 0.33, to: 0.71, radius: 0.02}", 10)).stepper->rods();
  EXPECT_NEAR(rods.positions[3].x(), 0.33, 1e-12);
  EXPECT_NEAR(rods.positions[7].x(), 0.71, 1e-12);
  EXPECT_EQ(rods.edge_radius(0, 2), 0.01);
  EXPECT_EQ(rods.edge_radius(0, 3), 0.02);
  EXPECT_EQ(rods.edge_radius(0, 6), 0.02);
  EXPECT_EQ(rods.edge_radius(0, 7), 0.01);
  EXPECT_TRUE(rods.mass_couplings.empty());
}

TEST_F(SimSceneTest, NaturalCurvatureLeavesRigidPartsOut) {
  std::string text = with_parts("{from: 0.4, to: 0.6, rigid: true}");
  text.replace(text.find("bend"), 4, "bend: {natural_curvature: 2}");
  text.replace(text.find("[stretch, bend: {natural_curvature: 2}]"), 39,
               "[stretch, {bend: {natural_curvature: 2}}]");
  const Rods rods = read(text).stepper->rods();
  EXPECT_NEAR(rods.natural_curvatures[1], 2.0, 1e-12);
  EXPECT_NEAR(rods.natural_curvatures[2] * rods.rest_length_at(2), 2.0 * 0.1, 1e-12);
}

/// A cable with a plug at its end falls on a table: each lies there by its own radius.
TEST_F(SimSceneTest, APlugRestsByItsOwnRadius) {
  SimScene scene = read(
      "fibers:\n"
      "  - name: cable\n"
      "    shape: {line: {from: [0, 0, 0.012], to: [0.3, 0, 0.012]}}\n"
      "    segments: 31\n"
      "    radius: 0.003\n"
      "    material: silicone_tube\n"
      "    sections: [{from: 0.26, radius: 0.01, rigid: true, material: {density: 3000}}]\n"
      "effects: [gravity, stretch, bend, damping, environment_contact, friction]\n"
      "environment: {obstacles: [{id: table, half_spaces: [{coef: [0, 0, 1, 0]}]}]}\n");
  while (scene.stepper->time() < 1.0) {
    scene.advance();
  }
  const Rods& rods = scene.stepper->rods();
  EXPECT_NEAR(rods.positions[0].z(), 0.003, 0.05 * 0.003);
  EXPECT_NEAR(rods.positions[30].z(), 0.01, 0.05 * 0.01);
  EXPECT_NEAR(rods.positions[31].z(), 0.01, 0.05 * 0.01);
}

std::string slot(const std::string& section) {
  return "fibers:\n"
         "  - name: cable\n"
         "    shape: {line: {from: [0, 0, -0.1], to: [0, 0, 0.06]}}\n"
         "    segments: 13\n"
         "    radius: 0.002\n"
         "    material: silicone_tube\n"
         "    sections: [{from: 0.12, rigid: true, " +
         section +
         "}]\n"
         "effects: [gravity, stretch, bend, environment_contact]\n"
         "environment:\n"
         "  obstacles:\n"
         "    - id: jaws\n"
         "      primitives: [{type: box, dimensions: [0.2, 0.2, 0.02]},\n"
         "                   {type: box, dimensions: [0.2, 0.2, 0.02]}]\n"
         "      primitive_poses: [{position: [0.104, 0, 0]}, {position: [-0.104, 0, 0]}]\n";
}

/// The cable hangs in a slot of 8 mm that its plug does not fit through.
TEST_F(SimSceneTest, APlugDoesNotPassWhereTheCableDoes) {
  SimScene thick = read(slot("radius: 0.006, material: {density: 5000}"));
  SimScene thin = read(slot("material: {density: 5000}"));
  while (thick.stepper->time() < 0.6) {
    thick.advance();
    thin.advance();
  }
  EXPECT_LT(thin.stepper->rods().positions.back().z(), -0.5) << "it falls through";
  for (std::uint32_t node = 12; node < 14; ++node) {
    EXPECT_GT(thick.stepper->rods().positions[node].z(), 0.01) << "above the jaws: node " << node;
  }
  EXPECT_LT(thick.stepper->rods().positions.front().z(), -0.05) << "it hangs through the slot";
}

/// A ring that is thrown along a held cable passes over it and stops at its thick part.
TEST_F(SimSceneTest, ARingStopsAtAShoulder) {
  const auto ring_scene = [&](const std::string& sections) {
    return read(
        "integrator: bdf2\n"
        "fibers:\n"
        "  - name: cable\n"
        "    shape: {line: {from: [0, 0, 0], to: [0.3, 0, 0]}}\n"
        "    segments: 30\n"
        "    radius: 0.003\n"
        "    material: power_cable\n"
        "    sections: [" +
        sections +
        "]\n"
        "  - name: ring\n"
        "    closed: true\n"
        "    shape: {polyline: [[0.05, 0.008, 0], [0.05, 0.004, 0.007], [0.05, -0.004, 0.007],\n"
        "                       [0.05, -0.008, 0], [0.05, -0.004, -0.007], [0.05, 0.004, "
        "-0.007]]}\n"
        "    segments: 12\n"
        "    radius: 0.002\n"
        "    material: power_cable\n"
        "    velocity: [2, 0, 0]\n"
        "effects:\n"
        "  - stretch\n"
        "  - bend: {natural_curvature: from_shape}\n"
        "  - fiber_contact\n"
        "  - attachment: [{fiber: cable, kind: clamp}, {fiber: cable, node: last, kind: clamp}]\n");
  };
  SimScene even = ring_scene("{from: 0.15, to: 0.2, material: {density: 3000}}");
  SimScene shoulder = ring_scene("{from: 0.15, to: 0.2, radius: 0.01}");
  double farthest = 0.0;
  while (even.stepper->time() < 0.08) {
    even.advance();
    shoulder.advance();
    farthest = std::max(farthest, shoulder.stepper->rods().positions.back().x());
  }
  EXPECT_GT(even.stepper->rods().positions.back().x(), 0.19) << "nothing stops it";
  EXPECT_LT(farthest, 0.16);
  EXPECT_GT(farthest, 0.12) << "it gets there";
}

TEST_F(SimSceneTest, FibresThatBeginInsideOfAThickPartAreRefused) {
  const std::string text =
      "fibers:\n"
      "  - {name: cable, shape: {line: {from: [0, 0, 0], to: [0.3, 0, 0]}}, segments: 30,\n"
      "     radius: 0.003, material: rope, sections: [{from: 0.1, to: 0.2, radius: 0.01}]}\n"
      "  - {name: other, shape: {line: {from: [AT, -0.1, 0.009], to: [AT, 0.1, 0.009]}},\n"
      "     segments: 20, radius: 0.003, material: rope}\n"
      "effects: [stretch, bend, fiber_contact]\n";
  const auto at = [&](const std::string& x) {
    std::string made = text;
    for (std::size_t i = made.find("AT"); i != std::string::npos; i = made.find("AT")) {
      made.replace(i, 2, x);
    }
    return made;
  };
  EXPECT_NE(error(at("0.15"))
                .find("segment 14 of fibre 'cable' and segment 9 of fibre 'other' are 4 mm deep in "
                      "it, 0.13 mm is the most"),
            std::string::npos);
  read(at("0.05"));
}

/// 0.8 - 0.1 is no 0.7: the end of a part is that of its fibre all the same.
TEST_F(SimSceneTest, APartThatEndsWithItsFiberLeavesNothingBehind) {
  std::string text = with_parts("{from: 0.6, to: 0.7, rigid: true}", 20);
  text.replace(text.find("{line: {from: [0, 0, 0], to: [1, 0, 0]}}"), 40,
               "{line: {from: [0.1, 0, 1], to: [0.8, 0, 1]}}");
  const SimScene scene = read(text);
  const Rods& rods = scene.stepper->rods();
  EXPECT_EQ(rods.node_count(0), 21U);
  for (std::uint32_t i = 0; i < 20; ++i) {
    EXPECT_GT(rods.rest_lengths[i], 0.03) << i;
  }
  EXPECT_NEAR(rods.rest_lengths[19], 0.1, 1e-9);
}

TEST_F(SimSceneTest, RigidPartsThatCannotBeAreErrors) {
  const std::vector<std::pair<std::string, std::string>> refused{
      {"{from: 0.2, to: 0.3, rigid: true}",
       "4: fibers[0].sections[0] is rigid and 0.1 m long, it must be no shorter than "
       "a segment of the rest of the fibre, 0.225 m (fibre 'cable')"},
      {"{from: 0.2, to: 0.5, rigid: true}, {from: 0.5, to: 0.8, rigid: true}",
       "4: fibers[0].sections[1] is rigid as the one right before it: they must be "
       "one (fibre 'cable')"},
      {"{from: 0.2, to: 0.6, radius: 0}",
       "4: fibers[0].sections[0].radius is 0, it must be above 0 (fibre 'cable')"},
      {"{from: 0.2, to: 0.21, radius: 0.02}",
       "2: fibers[0]: its 5 segment(s) are too few for a joint or the end of a section at 0.21 "
       "beside one at 0.2 of its length (fibre 'cable')"},
      {"{to: 0.99999, radius: 0.02}",
       "2: fibers[0]: between 0.999990 and 1.000000 of its length, where it, joints or sections "
       "end, segments "
       "would have 5e-05 of the length of others, at least 0.01 is allowed (fibre 'cable')"},
      {"{from: 0.001, radius: 0.02}",
       "2: fibers[0]: between 0.000000 and 0.001000 of its length, where it, joints or sections "
       "end, segments "
       "would have 0.005 of the length of others, at least 0.01 is allowed (fibre 'cable')"},
      {"{rigid: true}",
       "2: fibers[0]: its rigid sections leave 0 of its length to 4 of its 5 segments: each of "
       "them is one segment (fibre 'cable')"},
      {"{to: 0.999999999, rigid: true}",
       "2: fibers[0]: its rigid sections leave 0 of its length to 4 of its 5 segments: each of "
       "them is one segment (fibre 'cable')"},
  };
  for (const auto& [sections, expected] : refused) {
    EXPECT_EQ(error(with_parts(sections)), expected) << sections;
  }
  std::string closed = with_parts("{to: 0.6, rigid: true}, {from: 1.9, rigid: true}");
  closed.replace(closed.find("{line: {from: [0, 0, 0], to: [1, 0, 0]}}"), 40,
                 "{polyline: [[0, 0, 0], [1, 0, 0], [0.5, 0.8660254, 0]]}\n    closed: true");
  EXPECT_NE(error(closed).find("sections[1] is rigid and meets the first section, rigid as well, "
                               "where the fibre is closed"),
            std::string::npos)
      << error(closed);
  std::string bent = with_parts("{from: 0.4, to: 0.7, rigid: true}");
  bent.replace(bent.find("{line: {from: [0, 0, 0], to: [1, 0, 0]}}"), 40,
               "{polyline: [[0, 0, 0], [0.5, 0, 0], [0.5, 0.5, 0]]}");
  EXPECT_NE(error(bent).find(" degrees, at most 9 are allowed"), std::string::npos);
}

}  // namespace
}  // namespace fiber

// Sections of fibres, as scenes have them.
#include "test/sim/scene/scene_fixture.hpp"

namespace fiber {
namespace {

std::string with_sections(const std::string& sections) {
  std::string text = scene_text(line, "[stretch, bend]");
  text.replace(text.find("    segments: 4"), 15,
               "    sections: [" + sections + "]\n    segments: 4");
  return text;
}

TEST_F(SimSceneTest, SectionsHaveMaterialsOfTheirOwn) {
  const SimScene bare = read(scene_text(line, "[stretch, bend]"));
  const SimScene scene = read(
      with_sections("{to: 0.25, material: {density: 1600}}, {from: 0.5, material: silicone_tube}"));
  const Rods& rods = scene.stepper->rods();
  EXPECT_TRUE(bare.stepper->rods().section_lengths.empty()) << "it names none";
  const RodSection own = bare.stepper->rods().sections[0];
  const RodSection silicone = solid_round_section(material_preset("silicone_tube"), 0.01);
  EXPECT_EQ(rods.sections[0].bending_stiffness, own.bending_stiffness);
  EXPECT_NEAR(rods.section_lengths.bending[0], 0.125, 1e-12) << "only the density differs";
  EXPECT_NEAR(rods.section_lengths.bending[3],
              0.25 * own.bending_stiffness / silicone.bending_stiffness, 1e-9);
  const double per_length = own.mass_per_length;
  EXPECT_NEAR(rods.masses[0], 2.0 * 0.125 * per_length, 1e-12);
  EXPECT_NEAR(rods.masses[1], (2.0 + 1.0) * 0.125 * per_length, 1e-12);
  EXPECT_NEAR(rods.masses[3], 0.25 * silicone.mass_per_length, 1e-12);
}

/// A curve is longer than its edges: a section to its end is to the last node all the same.
TEST_F(SimSceneTest, SectionsOfCurvesAreMeasuredAlongTheCurve) {
  std::string text =
      scene_text("{arc: {from: [0, 0, 0], to: [1, 0, 0], length: 1.5}}", "[stretch, bend]");
  text.replace(text.find("    segments: 4"), 15,
               "    sections: [{from: 0.75, to: 1.5, material: {density: 1600}}]\n    segments: 4");
  const Rods rods = read(text).stepper->rods();
  EXPECT_NEAR(rods.masses[4], 2.0 * rods.masses[0], 1e-9);
  EXPECT_NEAR(rods.masses[2], 1.5 * rods.masses[1], 1e-6);
}

TEST_F(SimSceneTest, SectionsThatCannotBeAreErrors) {
  const std::vector<std::pair<std::string, std::string>> refused{
      {"{from: 0.2, to: 0.6, material: hair}, {from: 0.5, material: rope}",
       "4: fibers[0].sections[1] begins at 0.500000 m, it must be behind the section before, which "
       "ends at 0.600000 m (fibre 'cable')"},
      {"{from: 0.2, to: 1.2, material: hair}",
       "4: fibers[0].sections[0].to is 1.2, it must be beyond `from` and at most the fibre's "
       "length, 1 m (fibre 'cable')"},
      {"{from: 0.2, to: 0.1, material: hair}",
       "4: fibers[0].sections[0].to is 0.1, it must be beyond `from` and at most the fibre's "
       "length, 1 m (fibre 'cable')"},
      {"{from: -0.1, material: hair}",
       "4: fibers[0].sections[0].from is -0.1, it must be at least 0 and less than the fibre's "
       "length, 1 m (fibre 'cable')"},
      {"{from: 0.2}",
       "4: fibers[0].sections[0] changes nothing: a section has a material, a radius, or is rigid "
       "(fibre 'cable')"},
      {"{from: 0.2, material: {density: -1}}",
       "4: fibers[0].sections[0].material: density is -1.000000, it must be positive and finite "
       "(fibre 'cable')"},
      {"{from: 0.2, colour: 1, material: hair}",
       "4: fibers[0].sections[0] has the unknown key 'colour', known are: from, to, material, "
       "radius, rigid (fibre 'cable')"},
  };
  for (const auto& [sections, expected] : refused) {
    EXPECT_EQ(error(with_sections(sections)), expected) << sections;
  }
}

/// A scene whose fibre has these keys beside its material.
std::string of_material(const std::string& material, const std::string& keys,
                        const std::string& effects) {
  std::string text = scene_text(line, effects);
  const std::string own = "material: rope";
  text.replace(text.find(own), own.size(), "material: " + material + "\n    " + keys);
  return text;
}

TEST_F(SimSceneTest, FlatCablesBendToOneSideLessThanToAnother) {
  const Rods rods =
      read(of_material("{preset: rope, bending_ratio: 5}",
                       "stiff_towards: [3, 0, 2]\n    sections: [{from: 0.5, material: rope}]",
                       "[stretch, bend, twist]"))
          .stepper->rods();
  ASSERT_EQ(rods.stiff_sides.size(), 5U);
  const double bending = rods.sections[0].bending_stiffness;
  EXPECT_NEAR(rods.stiff_sides[1].stiffness, 4.0 * bending / 0.25, 1e-9 * bending);
  EXPECT_NEAR(rods.stiff_sides[2].stiffness, (1.0 / (0.125 / 5.0 + 0.125) - 4.0) * bending,
              1e-9 * bending)
      << "in series";
  EXPECT_EQ(rods.stiff_sides[3].stiffness, 0.0);
  const Eigen::Vector3d side =
      rods.stiff_sides[1].side.x() * rods.directors[0] +
      rods.stiff_sides[1].side.y() * rods.start_tangents[0].cross(rods.directors[0]);
  EXPECT_LE((side - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_TRUE(read(scene_text(line, "[stretch, bend, twist]")).stepper->rods().stiff_sides.empty());
}

/// To its stiff side a flat cable swings as a round one of that stiffness, damped as that is.
TEST_F(SimSceneTest, FlatCablesAreDampedByBothStiffnesses) {
  const auto tip = [this](const std::string& material, const std::string& keys,
                          const std::string& damping) {
    SimScene scene = read(of_material(
        material, keys,
        "[stretch, bend, twist, {damping: {relaxation_time: " + damping +
            "}}, {attachment: [{fiber: cable, node: first, kind: clamp, tangent: [1, 0, 0]}]}, "
            "{load: [{fiber: cable, node: last, force: [0, 0, 0.01]}]}]"));
    for (int i = 0; i < 5; ++i) {
      scene.advance();
    }
    return scene.stepper->rods().positions.back().z();
  };
  const std::string stiff = "{preset: rope, bending_share: 0.5}";
  const double round = tip(stiff, "", "0.5");
  const double undamped = tip(stiff, "", "0");
  const double flat = tip("{preset: rope, bending_share: 0.1, bending_ratio: 5}",
                          "stiff_towards: [0, 0, 1]", "0.5");
  EXPECT_GT(std::abs(undamped - round), 0.1 * undamped);
  EXPECT_NEAR(flat, round, 0.02 * std::abs(undamped - round));
}

/// A flat cable bends as the whole one where it is cut and welded, and where it is a closed fibre.
TEST_F(SimSceneTest, FlatCablesAreWeldedAndClosed) {
  const auto fiber = [](const std::string& name, const std::string& points,
                        const std::string& keys) {
    return "  - {name: " + name + ", shape: {polyline: " + points +
           "}, radius: 0.01, material: {preset: rope, bending_ratio: 9}, stiff_towards: [0, 0, "
           "1], " +
           keys + "}\n";
  };
  const auto sinks = [this](const std::string& fibers, const std::string& effects) {
    SimScene scene = read("fibers:\n" + fibers +
                          "effects: [gravity, stretch, bend, twist, {attachment: [{fiber: cable, "
                          "node: first, kind: clamp, tangent: [1, 0, 0]}]}" +
                          effects + "]\n");
    for (int i = 0; i < 10; ++i) {
      scene.advance();
    }
    return -scene.stepper->rods().positions.back().z();
  };
  const double whole = sinks(fiber("cable", "[[0, 0, 0], [1, 0, 0]]", "segments: 10"), "");
  const double welded =
      sinks(fiber("cable", "[[0, 0, 0], [0.4, 0, 0]]", "segments: 4") +
                fiber("rest", "[[0.4, 0, 0], [1, 0, 0]]", "segments: 6"),
            ", {joint: [{kind: weld, nodes: [{fiber: cable, node: last}, {fiber: rest}]}]}");
  EXPECT_GT(whole, 1e-3);
  EXPECT_NEAR(welded, whole, 1e-4 * whole);
  SimScene belt = read(
      "fibers:\n" +
      fiber("belt", "[[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]", "closed: true, segments: 12") +
      "effects: [gravity, stretch, bend, twist]\n");
  belt.advance();
  EXPECT_GT(belt.stepper->rods().stiff_sides[12].stiffness, 0.0);
  EXPECT_EQ(belt.stepper->report().unbalanced, 0U);
}

TEST_F(SimSceneTest, StiffSidesThatCannotBeAreErrors) {
  const std::string flat = "{preset: rope, bending_ratio: 5}";
  EXPECT_EQ(error(of_material(flat, "", "[stretch, bend, twist]")),
            "2: fibers[0] has no key 'stiff_towards' (fibre 'cable')");
  EXPECT_EQ(error(of_material("rope", "stiff_towards: [0, 0, 1]", "[stretch, bend, twist]")),
            "7: fibers[0].stiff_towards is [0, 0, 1], it must be absent where no material has a "
            "bending_ratio above 1 (fibre 'cable')");
  EXPECT_EQ(
      error(of_material(flat, "stiff_towards: [0, 0, 1]", "[stretch, bend]")),
      "7: fibers[0].stiff_towards is [0, 0, 1], but a bending_ratio above 1 takes the effects "
      "bend and twist");
  EXPECT_EQ(error(of_material(flat, "stiff_towards: [1, 0, 0]", "[stretch, bend, twist]")),
            "7: fibers[0].stiff_towards is [1, 0, 0], it must be finite and a direction across the "
            "fibre's first edge (fibre 'cable')");
  EXPECT_EQ(
      error(of_material(flat, "stiff_towards: [0, 0, 1]", "[bend, twist, plasticity]")),
      "8: effects[2]: plasticity: what stays has no direction, no fibre must be stiffer to one "
      "side");
  EXPECT_EQ(error(of_material("{preset: rope, bending_ratio: 0.5}", "stiff_towards: [0, 0, 1]",
                              "[stretch, bend, twist]")),
            "6: fibers[0].material: bending_ratio is 0.500000, it must be at least 1 and finite "
            "(fibre 'cable')");
}

}  // namespace
}  // namespace fiber

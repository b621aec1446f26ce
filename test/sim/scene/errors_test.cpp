#include "test/sim/scene/scene_fixture.hpp"

namespace fiber {
namespace {

TEST_F(SimSceneTest, ErrorsNameLineAndWhatIsAllowed) {
  struct Case {
    std::string text;
    std::string error;
  };
  const std::string held = "[stretch, {attachment: [";
  const std::vector<Case> cases{
      {scene_text(line, "[gravitation]"),
       ": effects[0]: there is no effect 'gravitation', known are: attachment, bend, damping"},
      {scene_text(line, "[{gravity: {acceleratoin: [0, 0, 1]}}]"),
       "7: effects[0].gravity has the unknown key 'acceleratoin', known are: acceleration"},
      {scene_text(line, "[{drag: {wind: {gusts: 1}}}]"),
       "7: effects[0].drag.wind has the unknown key 'gusts', known are: gust, gust_length"},
      {scene_text(line, "[{drag: {wind.mean: [1, 0, 0]}}]"),
       "7: effects[0].drag has the unknown key 'wind.mean', known are: across, along"},
      {scene_text(line, "[{stretch: {stiffness: 1}}]"), "has the unknown key 'stiffness'"},
      {scene_text(line, "[gravity, gravity]"), "the effect 'gravity' is there twice"},
      {scene_text(line, "[stretch, inextensible]"), "name one of them"},
      {scene_text(line, "[friction]"), "name self_contact, fiber_contact or environment_contact"},
      {scene_text(line, "[environment_contact]"), "the scene has no environment"},
      {scene_text(line, "[{damping: {relaxation_time: -1}}]"), "relaxation time is -1"},
      {scene_text(line, "[{self_contact: {restitution: 1.5}}]"),
       "7: effects[0]: contact: the restitution is 1.500000, it must be from 0 to 1"},
      {scene_text(line, "[{bend: {natural_curvature: -1}}]"),
       "7: effects[0].bend.natural_curvature is -1, it must be at least 0 and finite, or "
       "from_shape"},
      {scene_text(line, "[{bend: {natural_curvature: shape}}]"),
       "natural_curvature is shape, it must be at least 0 and finite, or from_shape"},
      {scene_text(line, "[{bend: {natural_curvature: 1, towards: [0, 1, 0]}}]"),
       "7: effects[0].bend.towards is [0, 1, 0], it must be absent where there is no twist"},
      {scene_text(line, "[{bend: {natural_curvature: 1, towards: [2, 0, 0]}}, twist]"),
       "7: effects[0].bend.towards is [2, 0, 0], it must be finite and a direction across the "
       "fibre's first edge (fibre 'cable')"},
      {scene_text(line, "[twist, {bend: {natural_curvature: 1, towards: 3}}]"),
       "towards is 3, it must be a list of 3 numbers"},
      {scene_text(line, "[twist, {bend: {towards: [0, 1, 0]}}]"),
       "it must be absent where there is no natural_curvature"},
      {scene_text(line, "[twist, {bend: {natural_curvature: from_shape, towards: [0, 1, 0]}}]"),
       "it must be absent where the natural curvature is from_shape"},
      {scene_text(line, "[twist, plasticity, {bend: {natural_curvature: from_shape}}]"),
       "7: effects[1]: plasticity: what stays has no direction"},
      {scene_text("{line: {from: [0, 0, 0], to: [0, 0, 0]}}", "[stretch]"),
       "2: fibers[0]: rod 0: edge 0 has no length: its points are the same (fibre 'cable')"},
      {scene_text("{circle: {}}", "[stretch]"), "has the unknown key 'circle', known are: arc"},
      {scene_text("{arc: {from: [0, 0, 0], to: [1, 0, 0], length: 0.5}}", "[stretch]"),
       "length is 0.5, it must be longer than"},
      {scene_text(line, held + "{fiber: rope}]}]"),
       "fiber is rope, it must be the name of a fibre of the scene: cable"},
      {scene_text(line, held + "{fiber: cable, node: 5}]}]"), "node is 5, it must be"},
      {scene_text(line, held + "{fiber: cable, node: 2, kind: clamp}]}]"),
       "kind is clamp, it must be pin, or node must be an end of a fibre that is not closed"},
      {scene_text(line, held + "{fiber: cable}, {fiber: cable, node: first}]}]"),
       "effects[1].attachment[1] holds node 0, which is held already: "},
      {scene_text(line, held + "{fiber: cable, path: [{time: 0}, {time: 0}]}]}]"),
       "time is 0, it must be later than the time before"},
      {scene_text(line, held + "{fiber: cable, path: [{time: 1}]}]}]"),
       "it must be 0, where the path begins (fibre 'cable')"},
      {scene_text(line, held + "{fiber: cable, path: [{time: 0}, {position: [0, 0, 1]}]}]}]"),
       "effects[1].attachment[0].path[1] has no key 'time' (fibre 'cable')"},
      {scene_text(line, held + "{fiber: cable, path: [{time: 0}, {time: .inf}]}]}]"),
       "time is .inf, it must be finite (fibre 'cable')"},
      {scene_text(line, held + "{fiber: cable, path: [{time: 0}, {time: 2}, {time: 1}]}]}]"),
       "time is 1, it must be later than the time before, 2.000000 s (fibre 'cable')"},
      {scene_text(line, held + "{fiber: cable, path: []}]}]"), "a list of at least one entry"},
      {scene_text(line, held + "{fiber: cable, path: [{time: 0}, {time: 1.0e-3, position: [0, 0, "
                               "2]}]}]}]"),
       "7: effects[1].attachment[0] moves with 2000.000000 m/s, it must be at most 1000.000000 "
       "m/s"},
      {scene_text(line, held + "{fiber: cable, path: [{time: 0, position: [0, 0, 0.3]}]}]}]"),
       "7: effects[1].attachment[0] begins 0.300000 m from where node 0 is, it must begin within "
       "0.250000 m, an edge's length (fibre 'cable')"},
      {scene_text(line, held + "{fiber: cable, position: [0, .nan, 0]}]}]"),
       "position is [0, .nan, 0], it must be finite"},
      {scene_text(
           line,
           held +
               "{fiber: cable, position: [0, .nan, 0], path: [{time: 0, position: [0, 0, 0]}]}]}]"),
       "position is [0, .nan, 0], it must be finite"},
      {scene_text("{line: {from: [0, 0, 0], to: [1, 0, 0]}, trefoil: {}}", "[stretch]"),
       "it must be a map of one shape, not of two"},
      {scene_text(line, "[stretch, plasticity]"),
       "plasticity: it is bending that yields, name the effect bend, too"},
      {scene_text(line, held + "{fiber: cable, path: [{time: 0}, {time: 2}], period: 2}]}]"),
       "period is 2, it must be longer than the path, 2.000000 s"},
      {scene_text(line, held + "{fiber: cable, kind: clamp, director: [1, 0.1, 0]}]}]"),
       "director is [1, 0.1, 0], it must be across the tangent (fibre 'cable')"},
      {scene_text(line, held + "{fiber: cable, frame: tool, path: [{time: 0}]}]}]"),
       "frame is tool, it must be absent where there is a path"},
      {scene_text(line, held + "{fiber: cable, period: 2}]}]"),
       "period is 2, it must be absent where there is no path"},
      {scene_text(line, held + "{fiber: cable, kind: clamp}, {fiber: cable, node: 0}]}]"),
       "which is held already: " + file_ + ":7: effects[1].attachment[0] (fibre 'cable')"},
      {scene_text(line, "[stretch]", "accuracy: 60 %\n"),
       "accuracy is 60 %, it must be above 0 and at most 0.5, or 50 %"},
      {scene_text(line, "[stretch]", "accuracy: 1 percent\n"), "accuracy is 1 percent"},
      {scene_text(line, "[stretch]", "accuracy: 0.01\nreal_time: true\n"),
       "real_time is true, it must be absent or false where there is an accuracy"},
      {scene_text(line, "[stretch]", "real_time: soon\n"), "real_time is soon"},
      {scene_text(line, "[stretch]", "time_step: 0\n"),
       "8: time_step is 0, it must be at least 1e-06 and at most 1000"},
      {scene_text(line, "[stretch]", "substeps: 0\n"), "substeps is 0"},
      {scene_text(line, "[stretch]", "integrator: euler\n"), "it must be implicit_euler or bdf2"},
      {scene_text(line, "[stretch]", "residual: 0\n"),
       "8: residual is 0, it must be at least 1e-09 and at most 1"},
      {scene_text(line, "[stretch]", "iterations: 0\n"), "iterations is 0"},
      {scene_text(line, "[stretch]",
                  "environment: {obstacles: [{id: b, frame_id: arm, half_spaces: "
                  "[{coef: [0, 0, 1, 0]}]}]}\n"),
       "obstacle 'b' is in frame 'arm', it must be in the scene's, 'world'"},
      {"fibers: [{name: \"a\\n\", shape: " + std::string(line) +
           ", segments: 1, radius: 0.01, material: \"ro\\npe\"}]\neffects: [stretch]\n",
       "there is no material 'ro\\npe', known are: hair, power_cable, rope, silicone_tube (fibre "
       "'a\\n')"},
  };
  for (const Case& bad : cases) {
    const std::string found = error(bad.text);
    EXPECT_NE(found.find(bad.error), std::string::npos) << found << "\nexpected " << bad.error;
  }
}

TEST_F(SimSceneTest, ErrorsOfMaterialsNameFibreAndLine) {
  for (const std::string value : {"youngs_modulus", "shear_modulus", "density"}) {
    std::string text = scene_text(line, "[stretch]");
    text.replace(text.find("rope"), 4, "{" + value + ": -1}");
    EXPECT_EQ(error(text), "6: fibers[0].material: " + value +
                               " is -1.000000, it must be positive and finite (fibre 'cable')");
  }
  std::string text = scene_text(line, "[stretch]");
  text.replace(text.find("    segments: 4\n"), 16, "");
  EXPECT_EQ(error(text), "2: fibers[0] has no key 'segments' (fibre 'cable')");
}

}  // namespace
}  // namespace fiber

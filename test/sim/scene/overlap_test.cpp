#include "test/sim/scene/scene_fixture.hpp"

namespace fiber {
namespace {

/// Two fibres of these shapes and this radius, which touch each other, themselves and a table.
std::string two_fibers(const std::string& a, const std::string& b, const std::string& more = "",
                       const std::string& contacts =
                           "self_contact, fiber_contact, "
                           "environment_contact, ") {
  const auto fiber = [](const std::string& name, const std::string& shape) {
    return "  - name: " + name + "\n    shape: " + shape +
           "\n    segments: 10\n    radius: 0.01\n    material: rope\n";
  };
  return "fibers:\n" + fiber("a", a) + fiber("b", b) + "effects: [" + contacts +
         "stretch, bend, twist]\nenvironment:\n  obstacles:\n    - {id: table, half_spaces: "
         "[{coef: [0.0, 0.0, 1.0, 0.0]}]}\n" +
         more;
}

const char* const high = "{line: {from: [0, 0, 1], to: [1, 0, 1]}}";
const char* const across = "{line: {from: [0.33, -0.5, 1.005], to: [0.33, 0.5, 1.005]}}";
const char* const far_away = "{line: {from: [0, 5, 1], to: [1, 5, 1]}}";

TEST_F(SimSceneTest, FibresThatBeginInEachOtherAreNamed) {
  const auto at = [this](int number) { return file_ + ":" + std::to_string(number); };
  EXPECT_EQ(error(two_fibers(high, across)),
            "2: fibers[0] begins inside of " + at(7) +
                ": fibers[1]: segment 3 of fibre 'a' and segment 4 of fibre 'b' are 15 mm deep in "
                "it, 0.2 mm is the most; so are 1 more pairs; move them apart, or have "
                "`initial_overlap: separate`");
  EXPECT_NE(error(two_fibers(high, high)).find("are 20 mm deep in it"), std::string::npos);
  EXPECT_EQ(error(two_fibers("{polyline: [[0, 0, 1], [0.4, 0, 1], [0.4, 0.3, 1], [0.2, 0.3, 1], "
                             "[0.2, -0.2, 1]]}",
                             far_away))
                .find("2: fibers[0] begins inside of itself: segment "),
            0U);
  EXPECT_EQ(error(two_fibers(far_away, "{line: {from: [0, 0, 1], to: [0, 0, 0.003]}}"))
                .find("7: fibers[1] begins inside of obstacle 'table': segment 9 of fibre 'b' is 7 "
                      "mm deep in it, 0.1 mm is the most; move them apart"),
            0U);
  EXPECT_EQ(error(two_fibers(high, far_away, "initial_overlap: maybe\n")),
            "16: initial_overlap is maybe, it must be refuse or separate");
}

TEST_F(SimSceneTest, OnlyContactsThatAreNamedMayNotBeginInEachOther) {
  EXPECT_EQ(error(two_fibers(high, across, "", "fiber_contact, ")).find("2: fibers[0] begins"), 0U);
  EXPECT_NO_THROW(read(two_fibers(high, across, "", "self_contact, environment_contact, ")));
  EXPECT_NO_THROW(read(two_fibers(high, high, "", "")));
  // They touch, and no more.
  EXPECT_NO_THROW(read(two_fibers(high, "{line: {from: [0, 0, 1.02], to: [1, 0.3, 1.02]}}")));
  EXPECT_NO_THROW(read(two_fibers(high, "{line: {from: [0, 0, 0.01], to: [1, 0, 0.01]}}")));
}

TEST_F(SimSceneTest, FibresMoveApartWhereTheSceneSaysSo) {
  const std::string separate = "initial_overlap: separate\n";
  for (const char* const other : {high, across}) {
    SimScene scene = read(two_fibers(high, other, separate));
    EXPECT_EQ(scene.overlap_note.find("initial_overlap: "), 0U) << scene.overlap_note;
    EXPECT_NE(scene.overlap_note.find("began inside of each other; nodes were moved by up to "),
              std::string::npos);
    const Rods& rods = scene.stepper->rods();
    EXPECT_NEAR(rods.rest_lengths[0], 0.1, 1e-12) << "lengths are those of the file";
    const std::vector<Eigen::Vector3d> beginning = rods.positions;
    for (int i = 0; i < 50; ++i) {
      scene.stepper->step(1.0 / 240.0);
      for (std::size_t node = 0; node < beginning.size(); ++node) {
        ASSERT_LT((rods.positions[node] - beginning[node]).norm(), 0.05) << "it bursts";
      }
    }
  }
  EXPECT_EQ(read(two_fibers(high, far_away, separate)).overlap_note, "");
  std::string held = two_fibers(high, high, separate);
  held.replace(held.find("twist"), 5,
               "twist, {attachment: [{fiber: a}, {fiber: b}, {fiber: a, node: last}]}");
  EXPECT_NE(error(held).find(", where `initial_overlap: separate` has moved them"),
            std::string::npos);
}

}  // namespace
}  // namespace fiber

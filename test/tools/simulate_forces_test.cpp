// fiber_simulate --forces
#include <cmath>
#include <map>

#include "test/tools/simulate.hpp"

namespace fiber::test {
namespace {

TEST_F(Simulate, ForcesAreAFileOfTheirOwn) {
  // One hangs, one lies on a table and on nothing else.
  const std::string scene = write(
      "scene.yaml",
      "residual: 1.0e-7\n"
      "fibers:\n"
      "  - {name: hangs, shape: {line: {from: [0, 0, 1], to: [0, 0, 0.5]}}, segments: 10, radius: "
      "0.005, material: silicone_tube}\n"
      "  - {name: lies, shape: {line: {from: [1, 0, 0.005], to: [1.5, 0, 0.005]}}, segments: 10, "
      "radius: 0.005, material: silicone_tube}\n"
      "effects:\n"
      "  - gravity\n"
      "  - stretch\n"
      "  - bend\n"
      "  - damping\n"
      "  - fiber_contact\n"
      "  - environment_contact\n"
      "  - friction\n"
      "  - attachment: [{fiber: hangs}]\n"
      "environment: {obstacles: [{id: table, half_spaces: [{coef: [0, 0, 1, 0]}]}]}\n");
  frames(scene, "--seconds 5 --forces " + path("forces.csv"));
  // The weight of half a metre of silicone tube [N].
  const double weight = 9.81 * 1150.0 * M_PI * 0.005 * 0.005 * 0.5;
  std::map<std::string, std::size_t> counts;
  Eigen::Vector3d hold = Eigen::Vector3d::Zero();
  Eigen::Vector3d contacts = Eigen::Vector3d::Zero();
  std::int64_t frame = 1;
  for (const ForceRow& row : force_rows(read_file(path("forces.csv")))) {
    EXPECT_TRUE(row.frame == frame || row.frame == frame + 1);
    frame = row.frame;
    if (frame < 300) {
      continue;
    }
    ++counts[row.kind];
    if (row.kind == "hold") {
      EXPECT_EQ(std::make_pair(row.fiber, row.index), std::make_pair(0U, 0U));
      hold += row.force;
    } else if (row.kind == "normal" || row.kind == "friction") {
      EXPECT_EQ(row.fiber, 1U);
      contacts += row.force;
    } else if (row.kind == "tension" && row.fiber == 0) {
      // The part below the middle of the edge pulls it down.
      const Eigen::Vector3d below(0, 0, -weight * (0.95 - 0.1 * row.index));
      EXPECT_LT((row.force - below).norm(), 1e-3 * weight) << row.index;
    } else if (row.kind == "bending" || row.kind == "twisting") {
      EXPECT_TRUE(row.force.isZero(0.0));
    }
  }
  EXPECT_EQ(frame, 300);
  EXPECT_EQ(counts["tension"], 20U);
  EXPECT_EQ(counts["twisting"], 20U);
  EXPECT_EQ(counts["bending"], 22U);
  EXPECT_EQ(counts["hold"], 1U);
  EXPECT_GE(counts["normal"], 10U);
  EXPECT_LT((hold - Eigen::Vector3d(0, 0, weight)).norm(), 1e-3 * weight) << hold.transpose();
  EXPECT_LT((contacts - Eigen::Vector3d(0, 0, weight)).norm(), 1e-3 * weight)
      << contacts.transpose();
}

}  // namespace
}  // namespace fiber::test

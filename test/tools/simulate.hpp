#pragma once

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "test/tools/tools_test.hpp"

namespace fiber::test {

/// A rope that a gripper lifts from a table, and one that falls on it.
inline const char* const ropes =
    "fibers:\n"
    "  - {name: lifted, shape: {line: {from: [0, 0, 0.02], to: [1, 0, 0.02]}}, segments: 20, "
    "radius: "
    "0.01, material: silicone_tube}\n"
    "  - {name: falling, shape: {line: {from: [0.5, -0.5, 0.5], to: [0.5, 0.5, 0.5]}}, segments: "
    "10, "
    "radius: 0.005, material: silicone_tube, repeat: {count: 2, offset: [0.1, 0, 0]}}\n"
    "effects:\n"
    "  - gravity\n"
    "  - stretch\n"
    "  - bend\n"
    "  - fiber_contact\n"
    "  - environment_contact\n"
    "  - friction\n"
    "  - attachment: [{fiber: lifted, path: [{time: 0}, {time: 1, position: [0, 0, 0.52]}]}]\n"
    "environment: {obstacles: [{id: table, half_spaces: [{coef: [0, 0, 1, 0]}]}]}\n";

/// A row of a file of forces.
struct ForceRow {
  std::int64_t frame;
  std::string kind;
  std::uint32_t fiber;
  std::uint32_t index;
  Eigen::Vector3d force;
  Eigen::Vector3d moment;
};

inline std::vector<ForceRow> force_rows(const std::string& text) {
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line, "frame,kind,fiber,index,fx,fy,fz,mx,my,mz");
  std::vector<ForceRow> rows;
  while (std::getline(lines, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields(line);
    ForceRow& row = rows.emplace_back();
    fields >> row.frame >> row.kind >> row.fiber >> row.index;
    for (Eigen::Vector3d* const vector : {&row.force, &row.moment}) {
      fields >> vector->x() >> vector->y() >> vector->z();
    }
    EXPECT_TRUE(fields && fields.peek() == std::istringstream::traits_type::eof()) << line;
  }
  return rows;
}

class Simulate : public ToolsTest {
 protected:
  static ProcessResult simulate(const std::string& arguments) {
    return run_process(FIBER_SIMULATE " " + arguments);
  }

  /// The frames that the tool writes of a scene, and nothing else.
  std::vector<FiberFrame> frames(const std::string& scene, const std::string& options) const {
    const ProcessResult result = simulate(scene + " " + options + " --out " + path("out.csv"));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(result.err, "");
    return read_csv(path("out.csv")).frames;
  }
};

}  // namespace fiber::test

// fiber_simulate --trajectory
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "test/tools/simulate.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// What the first rope is to do in place of rising.
const char* const along_the_table =
    "- {fiber: lifted, path: [{time: 0}, {time: 0.25, position: [0.1, 0, 0.02]}]}\n"
    "- {fiber: lifted, node: last, path: [{time: 0}]}\n";

/// The frames of a run along a trajectory, and what it tells of it.
class SimulateTrajectory : public Simulate {
 protected:
  std::string simulate_along(const std::string& scene, const std::string& options) {
    const ProcessResult result = simulate(write("scene.yaml", scene) + " --trajectory " +
                                          write("trajectory.yaml", along_the_table) + " --out " +
                                          path("out.csv") + " " + options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    frames_ = read_csv(path("out.csv")).frames;
    return result.out;
  }

  std::vector<FiberFrame> frames_;
};

TEST_F(SimulateTrajectory, HoldsGoAlongItInPlaceOfTheirs) {
  simulate_along(ropes, "--seconds 0.25");
  ASSERT_EQ(frames_.size(), 16U);
  const std::vector<Vector3d>& begin = frames_.front().fibers.points();
  const std::vector<Vector3d>& end = frames_.back().fibers.points();
  EXPECT_NEAR(end[0].x(), 0.1, 1e-3) << "it does not rise as in the scene";
  EXPECT_NEAR(end[0].z(), 0.02, 1e-3);
  EXPECT_NEAR((end[20] - begin[20]).norm(), 0.0, 1e-3) << "held, which the scene does not";
}

TEST_F(SimulateTrajectory, RefusesWhatIsNone) {
  const std::string run = write("scene.yaml", ropes) + " --seconds 0.1 --out " + path("none.csv");
  const auto refusal = [&](const std::string& text, const std::string& error) {
    return refused(simulate(run + " --trajectory " + write("bad.yaml", text)), error);
  };
  EXPECT_TRUE(refusal("- {fiber: rope}\n", "bad.yaml:1: "));
  EXPECT_TRUE(refusal("- {fiber: lifted, path: [{time: 1}, {time: 1}]}\n", "bad.yaml:1: "));
  EXPECT_TRUE(refused(simulate(run + " --margin 0.1"), "--trajectory"));
  EXPECT_TRUE(refused(
      simulate(run + " --margin -1 --trajectory " + write("trajectory.yaml", along_the_table)),
      "--margin"));
  EXPECT_FALSE(std::filesystem::exists(path("none.csv")));
}

/// A value, and the time at which it is the least or the greatest.
struct Extreme {
  double value;
  double time;
};

std::string text_of(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

/// The least gap of two fibres in the frames, segment by segment.
Extreme least_gap(const std::vector<FiberFrame>& frames, std::uint32_t a, std::uint32_t b) {
  Extreme least{1e9, 0.0};
  for (const FiberFrame& frame : frames) {
    const std::vector<Vector3d>& x = frame.fibers.points();
    const std::vector<std::uint32_t>& offsets = frame.fibers.offsets();
    for (std::uint32_t i = offsets[a]; i + 1 < offsets[a + 1]; ++i) {
      for (std::uint32_t j = offsets[b]; j + 1 < offsets[b + 1]; ++j) {
        const double gap = segment_distance(x[i], x[i + 1], x[j], x[j + 1]).distance -
                           frame.fibers.segment_radius(i) - frame.fibers.segment_radius(j);
        if (gap < least.value) {
          least = {gap, static_cast<double>(frame.frame) / 60.0};
        }
      }
    }
  }
  return least;
}

/// The least gap between a fibre and the table, the half-space below z = 0.
Extreme least_height(const std::vector<FiberFrame>& frames, std::uint32_t fiber) {
  Extreme least{1e9, 0.0};
  for (const FiberFrame& frame : frames) {
    const std::vector<std::uint32_t>& offsets = frame.fibers.offsets();
    for (std::uint32_t i = offsets[fiber]; i < offsets[fiber + 1]; ++i) {
      const double gap = frame.fibers.points()[i].z() -
                         frame.fibers.segment_radius(std::min(i, offsets[fiber + 1] - 2));
      if (gap < least.value) {
        least = {gap, static_cast<double>(frame.frame) / 60.0};
      }
    }
  }
  return least;
}

/// Beside what the files of the same run say: distances by frames, forces by rows.
TEST_F(SimulateTrajectory, TellsWhatComesOfIt) {
  const std::string told =
      simulate_along(ropes, "--seconds 0.25 --margin 0.2 --forces " + path("forces.csv"));
  const auto expect_line = [&](const std::string& begin, const std::string& end) {
    const std::size_t at = told.find(begin);
    ASSERT_NE(at, std::string::npos) << begin << "\n" << told;
    const std::string line = told.substr(at, told.find('\n', at) - at);
    EXPECT_EQ(line.substr(line.size() - std::min(line.size(), end.size())), end) << line;
  };
  EXPECT_EQ(told.find("prediction: 0.25 s, by the ends of frames\n"), 0U) << told;
  const Extreme height = least_height(frames_, 0);
  ASSERT_LT(height.value, 0.001) << "it falls on the table";
  expect_line("clearance: " + text_of(height.value) + " m of fibre 'lifted' and obstacle 'table', ",
              ", at " + text_of(height.time) + " s");
  const Extreme gap = least_gap(frames_, 0, 1);
  expect_line("clearance: " + text_of(gap.value) + " m of fibre 'lifted' and fibre 'falling_0', ",
              ", at " + text_of(gap.time) + " s");
  expect_line("clearance: all other", "further apart than 0.2 m");

  std::map<std::pair<std::int64_t, std::uint32_t>, double> pressures;  // by frame and fibre
  std::map<std::uint32_t, std::pair<Extreme, std::uint32_t>> tensions;
  std::map<std::uint32_t, Extreme> holds;  // by node
  for (const ForceRow& row : force_rows(read_file(path("forces.csv")))) {
    const double time = static_cast<double>(row.frame) / 60.0;
    const FiberAssembly& fibers = frames_[static_cast<std::size_t>(row.frame)].fibers;
    if (row.kind == "tension") {
      const std::uint32_t first = fibers.offsets()[row.fiber] + row.index;
      const double pull =
          row.force.dot((fibers.points()[first + 1] - fibers.points()[first]).normalized());
      if (pull > tensions[row.fiber].first.value) {
        tensions[row.fiber] = {{pull, time}, row.index};
      }
    } else if (row.kind == "hold" && row.force.norm() > holds[row.index].value) {
      holds[row.index] = {row.force.norm(), time};
    } else if (row.kind == "normal") {
      pressures[{row.frame, row.fiber}] += row.force.norm();
    }
  }
  const auto& [pull, edge] = tensions[0];
  expect_line("tension: at most " + text_of(pull.value) + " N at edge " + std::to_string(edge) +
                  " of fibre 'lifted'",
              ", at " + text_of(pull.time) + " s");
  ASSERT_EQ(holds.size(), 2U);
  for (const auto& [node, hold] : holds) {
    expect_line("hold: at most " + text_of(hold.value) + " N at node " + std::to_string(node) +
                    " of fibre 'lifted'",
                ", at " + text_of(hold.time) + " s");
  }
  // The table is all that presses on it, as the others are still above.
  ASSERT_GT(gap.value, 0.001);
  Extreme pressed{0.0, 0.0};
  Extreme first{0.0, 1e9};
  Extreme last{0.0, 0.0};
  for (const auto& [place, force] : pressures) {
    const double time = static_cast<double>(place.first) / 60.0;
    if (place.second == 0 && force > 0.0) {
      first.time = std::min(first.time, time);
      last.time = std::max(last.time, time);
      pressed = force > pressed.value ? Extreme{force, time} : pressed;
    }
  }
  expect_line("contact: fibre 'lifted' and obstacle 'table' from ",
              " from " + text_of(first.time) + " s to " + text_of(last.time) + " s, at most " +
                  text_of(pressed.value) + " N, at " + text_of(pressed.time) + " s");
  std::ptrdiff_t near = 0;
  for (std::uint32_t fiber = 0; fiber < 3; ++fiber) {
    near += least_height(frames_, fiber).value <= 0.2 ? 1 : 0;
    for (std::uint32_t other = 0; other < fiber; ++other) {
      near += least_gap(frames_, other, fiber).value <= 0.2 ? 1 : 0;
    }
  }
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), near + 8) << told;
}

TEST_F(SimulateTrajectory, TellsThatNothingComesNear) {
  const std::string told = simulate_along(ropes, "--seconds 0 --margin 0.001");
  EXPECT_EQ(told.substr(0, told.find("tension")),
            "prediction: 0 s, by the ends of frames\n"
            "clearance: all other bodies stay further apart than 0.001 m\n"
            "contact: none\n");
}

/// What is told is of frames that ended too early.
TEST_F(SimulateTrajectory, TellsHowManyFramesDoNotBalance) {
  const std::string told = simulate(write("scene.yaml", ropes + std::string("iterations: 1\n")) +
                                    " --seconds 0.1 --out " + path("out.csv") + " --trajectory " +
                                    write("trajectory.yaml", along_the_table))
                               .out;
  EXPECT_NE(told.find(" frame(s) ended before forces balanced\n"), std::string::npos) << told;
}

}  // namespace
}  // namespace fiber::test

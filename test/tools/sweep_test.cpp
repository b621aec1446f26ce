// fiber_query sweep
#include <sstream>
#include <string>
#include <vector>

#include "test/tools/tools_test.hpp"

namespace fiber::test {
namespace {

const std::string sweep_header =
    "frame,fiber_a,segment_a,fiber_b,segment_b,time_lower,time_upper\n";

/// A fibre along y that stays, and one along x at this height, in a frame.
std::string frame(int number, double height, const std::string& middle = "") {
  std::ostringstream rows;
  rows << number << ",0,0,-1,0,0.05\n" << number << ",0,0,1,0,0.05\n";
  rows << number << ",1,-1,0.5," << height << ",0.05\n";
  rows << middle;
  rows << number << ",1,1,0.5," << height << ",0.05\n";
  return rows.str();
}

class Sweep : public ToolsTest {
 protected:
  std::string file(const std::string& rows) const {
    return write("cables.csv", "frame,fiber,x,y,z,radius\n" + rows);
  }
  /// The rows after the header.
  std::vector<std::vector<double>> rows(const std::string& arguments) const {
    const ProcessResult result = query("sweep " + arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.out.substr(0, sweep_header.size()), sweep_header);
    std::istringstream lines(result.out.substr(std::min(sweep_header.size(), result.out.size())));
    std::vector<std::vector<double>> all;
    for (std::string line; std::getline(lines, line);) {
      all.push_back(numbers_in(line));
    }
    return all;
  }
};

TEST_F(Sweep, FindsWhatPassesThroughBetweenFrames) {
  const std::string cables = file(frame(3, 1.1) + frame(4, 0.6) + frame(5, -0.4) + frame(8, -1.4));
  EXPECT_EQ(query("contacts " + cables).out.find('\n'), query("contacts " + cables).out.size() - 1)
      << "no frame has a contact";
  const auto found = rows(cables + " --margin 0 --tolerance 1e-9");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(std::vector<double>(found[0].begin(), found[0].begin() + 5),
            (std::vector<double>{4, 0, 0, 1, 0}));
  // From 0.6 m to 0.1 m, the sum of the radii, in a step of 1 m.
  EXPECT_LE(found[0][5], 0.5);
  EXPECT_GE(found[0][6], 0.5);
  EXPECT_LE(found[0][6] - found[0][5], 1e-8);
}

TEST_F(Sweep, BoundsAreAsNearAsIsAsked) {
  const std::string command = file(frame(0, 0.6) + frame(1, 0.09)) + " --tolerance 1e-2";
  const auto wide = rows(command);
  const auto narrow = rows(command + " --time-tolerance 1e-9");
  ASSERT_EQ(wide.size(), 1U);
  ASSERT_EQ(narrow.size(), 1U);
  EXPECT_GT(wide[0][6] - wide[0][5], 1e-3);
  EXPECT_LE(narrow[0][6] - narrow[0][5], 1e-9);
  EXPECT_GE(narrow[0][5], wide[0][5]);
  EXPECT_LE(narrow[0][6], wide[0][6]);
}

TEST_F(Sweep, TheMarginCounts) {
  const auto found = rows(file(frame(0, 1.1) + frame(1, 0.6)) + " --margin 0.75");
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0][5], 0.5, 1e-5);
}

TEST_F(Sweep, WhatIsInContactAlreadyIsThereAtTimeZero) {
  const std::string cables = file(frame(0, 0.05) + frame(1, 0.5) + frame(2, 0.0));
  const auto found = rows(cables);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0], (std::vector<double>{0, 0, 0, 1, 0, 0, 0}));
  EXPECT_EQ(found[1][0], 1.0);
  EXPECT_GT(found[1][5], 0.0);
  const auto fresh = rows(cables + " --new-only");
  ASSERT_EQ(fresh.size(), 1U);
  EXPECT_EQ(fresh[0], found[1]);
}

TEST_F(Sweep, FirstIsTheEarliestOfAStep) {
  // The end at x = 1 comes down first.
  const auto tilted = [](int number, double height) {
    std::ostringstream rows;
    rows << number << ",0,-1,0,0,0.01\n" << number << ",0,1,0,0,0.01\n";
    rows << number << ",1,-1,0," << height + 0.5 << ",0.01\n";
    rows << number << ",1,0,0," << height + 0.25 << ",0.01\n";
    rows << number << ",1,1,0," << height << ",0.01\n";
    return rows.str();
  };
  const std::string cables = file(tilted(0, 0.5) + tilted(1, -1.0));
  const auto all = rows(cables);
  ASSERT_EQ(all.size(), 2U);
  const auto first = rows(cables + " --type first");
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0], all[1]);
  EXPECT_LT(all[1][5], all[0][5]);
}

TEST_F(Sweep, EveryEngineAnswersTheSame) {
  const std::string cables = path("tress.csv");
  ASSERT_EQ(scene("cables --frames 3 --out " + cables).exit_code, 0);
  const std::string expected = query("sweep " + cables + " --margin 0.01").out;
  EXPECT_GT(expected.size(), sweep_header.size());
  for (const std::string engine : {"AL", "DS-20", "brute_force"}) {
    EXPECT_EQ(query("sweep " + cables + " --margin 0.01 --engine " + engine).out, expected);
  }
}

TEST_F(Sweep, OtherFibresInTheNextFrameAreTold) {
  const std::string cables = file(frame(0, 0.05) + frame(1, 0.5, "1,1,0,0.5,0.5,0.05\n") +
                                  frame(2, -0.5, "2,1,0,0.5,-0.5,0.05\n"));
  const ProcessResult result = query("sweep " + cables);
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(
      result.err,
      "fiber_query: frames 0 and 1 have different fibres (of other numbers of points: '1'): of "
      "these only the contacts that frame 0 has itself\n");
  EXPECT_NE(result.out.find("\n0,0,0,1,0,0,0\n"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("\n1,0,0,1,"), std::string::npos) << result.out;
}

TEST_F(Sweep, RefusesWhatItCannotAnswer) {
  const std::string two = file(frame(0, 1.0) + frame(1, 0.5));
  EXPECT_TRUE(refused(query("sweep " + two + " --margin -1"), "margin is -1"));
  EXPECT_TRUE(refused(query("sweep " + two + " --margin nan"), "margin is nan"));
  EXPECT_TRUE(refused(query("sweep " + two + " --tolerance -1e-9"), "tolerance"));
  EXPECT_TRUE(refused(query("sweep " + two + " --tolerance inf"), "tolerance"));
  EXPECT_TRUE(refused(query("sweep " + two + " --time-tolerance -1"), "time_tolerance is -1"));
  EXPECT_TRUE(refused(query("sweep " + two + " --time-tolerance nan"), "time_tolerance is nan"));
  EXPECT_TRUE(refused(query("sweep " + two + " --type last"), "last"));
  EXPECT_TRUE(
      refused(query("sweep " + write("one.csv", "frame,fiber,x,y,z\n0,a,0,0,0\n0,a,1,0,0\n")),
              "one frame"));
  EXPECT_TRUE(
      refused(query("sweep " + write("none.csv", "fiber,x,y,z\na,0,0,0\na,1,0,0\n")), "no frames"));
  EXPECT_TRUE(
      refused(query("sweep " + file(frame(0, 1.0) + frame(1, 0.5) + "2,a,nan,0,0,1\n")), "nan"));
}

}  // namespace
}  // namespace fiber::test

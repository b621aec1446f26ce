// `fiber_query check`: which candidates could be there, without MPI.
#include <string>

#include "test/tools/tools_test.hpp"

namespace fiber::test {
namespace {

class Check : public ToolsTest {
 protected:
  /// Bars along x at heights of 0.5, 1.5 and so on, one in each frame, with a radius of 0.1 m.
  std::string bars(int count) const {
    std::string text = "frame,fiber,x,y,z,radius\n";
    for (int i = 0; i < count; ++i) {
      for (const std::string x : {"0", "1"}) {
        text += std::to_string(i) + ",bar," + x + ",0," + std::to_string(i) + ".5,0.1\n";
      }
    }
    return write("bars.csv", text);
  }
  std::string ball_at(const std::string& z) const {
    return write("world.yaml", "obstacles:\n  - {id: 'a \"ball\"', pose: {position: [0.5, 0, " + z +
                                   "]}, primitives: [{type: sphere, dimensions: [0.3]}]}\n");
  }
};

const std::string none(18, ',');

TEST_F(Check, ARowTellsWhatACandidateTouches) {
  const ProcessResult result =
      query("check " + bars(3) + " --environment " + ball_at("1.25") + " --neighbour-skip 1");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::vector<std::string> rows = lines(result.out);
  ASSERT_EQ(rows.size(), 4U) << result.out;
  EXPECT_EQ(rows[0].substr(0, 39), "frame,free,with,object,fiber_a,segment_");
  EXPECT_EQ(rows[1], "0,1" + none + ",,");
  EXPECT_EQ(rows[2].substr(0, 34), "1,0,object,\"a \"\"ball\"\"\",bar,0,0.5,");
  EXPECT_EQ(rows[3], "2,1" + none + ",,");
}

TEST_F(Check, FibresThatThereAreAndTheCandidateItselfCount) {
  const std::string there = write("there.csv",
                                  "fiber,x,y,z,radius\nrope,0.5,-1,0.5,0.1\nrope,0.5,1,0.5,0.1\n"
                                  "wire,0.5,-1,2.65,0.1\nwire,0.5,1,2.65,0.1\n");
  ProcessResult result = query("check " + bars(4) + " --fibers " + there);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  std::vector<std::string> rows = lines(result.out);
  ASSERT_EQ(rows.size(), 5U) << result.out;
  EXPECT_EQ(rows[1].substr(0, 28), "0,0,fiber,,bar,0,0.5,rope,0,");
  EXPECT_EQ(rows[2], "1,1" + none + ",,");
  EXPECT_EQ(rows[3].substr(0, 28), "2,0,fiber,,bar,0,0.5,wire,0,");

  const std::string knot = write("knot.csv",
                                 "fiber,x,y,z,radius\na,0,0,0,0.1\na,1,0,0,0.1\n"
                                 "b,0.5,-1,0.1,0.1\nb,0.5,1,0.1,0.1\n");
  rows = lines(query("check " + knot).out);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[1].substr(0, 26), "0,candidate,,a,0,0.5,b,0,0");
  rows = lines(query("check " + knot + " --without-self").out);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[1], "1" + none + ",,");
}

TEST_F(Check, MoreCandidatesThanAreCheckedAtOnceStayInOrder) {
  const ProcessResult result = query("check " + bars(600) + " --environment " + ball_at("300.25"));
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::vector<std::string> rows = lines(result.out);
  ASSERT_EQ(rows.size(), 601U);
  for (std::size_t i = 0; i < 600; ++i) {
    EXPECT_EQ(rows[i + 1].rfind(std::to_string(i) + (i == 300 ? ",0,object," : ",1,,,"), 0), 0U)
        << rows[i + 1];
  }
}

TEST_F(Check, WhatIsWrongIsRefused) {
  EXPECT_TRUE(refused(query("check " + path("absent.csv")), "cannot be opened"));
  EXPECT_TRUE(refused(query("check " + bars(1) + " --margin -1"), "margin is -1"));
  EXPECT_TRUE(refused(query("check " + bars(1) + " --type limited"), "--type"));
  EXPECT_TRUE(refused(query("check " + bars(1) + " --environment " + path("absent.yaml")),
                      "there is no such file"));
  const std::string nothing = write("none.csv", "frame,fiber,x,y,z,radius\n");
  EXPECT_TRUE(refused(query("check " + bars(1) + " --fibers " + nothing), "has no fibres"));
  EXPECT_EQ(lines(query("check " + nothing).out).size(), 1U) << "candidates where there are none";
}

}  // namespace
}  // namespace fiber::test

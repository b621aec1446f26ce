// fiber_query says why it refuses something.
#include <string>

#include "test/tools/fiber_query.hpp"

namespace fiber::test {
namespace {

TEST_F(FiberQuery, NearestRefusesBadPointsAndCounts) {
  const std::string nearest = "nearest " + crossing();
  EXPECT_TRUE(refused(query(nearest), "--point is required"));
  for (const std::string point :
       {"1,2", "1,2,3,4", "1,2,3,", "1;2;3", "a,b,c", "1,,3", "1,2,", ",,", "0,nan,0", "inf,0,0",
        "0,0,-1e200", "1,2,3x", "\"1, 2, 3\""}) {
    EXPECT_TRUE(refused(query(nearest + " --point " + (point == "1;2;3" ? "'1;2;3'" : point)),
                        "must be three numbers X,Y,Z; coordinates must be finite and at most 1e150 "
                        "m in magnitude"))
        << point;
  }
  for (const std::string k : {"0", "-1", "two", "1.5"}) {
    EXPECT_TRUE(refused(query(nearest + " --point 0,0,0 --k " + k),
                        "--k: '" + k + "' must be a whole number from 1"));
  }
  EXPECT_TRUE(refused(query(nearest + " --point 0,0,0 --k 4294967296"), "--k"));
  EXPECT_TRUE(refused(query(nearest + " --point 0,0,0 --margin 1"), "--margin"));
  EXPECT_TRUE(refused(query("contacts " + crossing() + " --point 0,0,0"), "--point"));
}

TEST_F(FiberQuery, RefusesBadCommandLines) {
  const std::string file = crossing();
  EXPECT_TRUE(
      refused(query(""),
              "a subcommand is needed: contacts, closest, first, fiber_pairs, nearest, segments"));
  EXPECT_TRUE(refused(query("touches " + file), "touches"));
  EXPECT_TRUE(refused(query("contacts"), "FILE"));
  EXPECT_TRUE(refused(query("contacts " + file + " --frobnicate"), "--frobnicate"));
  EXPECT_TRUE(refused(query("contacts " + file + " more.csv"), "more.csv"));
  EXPECT_TRUE(refused(query("contacts " + file + " --engine XL"), "'XL', known are: run_tree, AL"));
  EXPECT_TRUE(refused(query("contacts " + file + " --format xml"), "--format: xml"));
  EXPECT_TRUE(refused(query("contacts " + file + " --threads x"), "--threads: 'x'"));
  EXPECT_TRUE(
      refused(query("contacts " + file + " --margin wide"), "--margin: 'wide' must be a number"));
  EXPECT_TRUE(refused(query("contacts " + file + " --margin -1"), "margin is -1"));
  EXPECT_TRUE(refused(query("contacts " + file + " --margin nan"), "margin is nan"));
  EXPECT_TRUE(refused(query("contacts " + file + " --margin"), "--margin"));
  EXPECT_TRUE(refused(query("contacts " + file + " --neighbour-skip -1"), "--neighbour-skip = -1"));
  EXPECT_TRUE(refused(query("contacts " + file + " --neighbour-skip-length -1"),
                      "neighbour_skip_length is -1"));
  EXPECT_TRUE(refused(query("contacts " + file + " --radius -1"), "radius is -1"));
}

TEST_F(FiberQuery, RefusesBadFilesNamingFileLineAndReason) {
  EXPECT_TRUE(refused(query("contacts " + path("none.csv")),
                      path("none.csv") + ": cannot be opened: No such file or directory"));
  EXPECT_TRUE(refused(query("contacts /"), "/: cannot be read: Is a directory"));
  const std::string head = "fiber,x,y,z\n0,0,0,0\n";
  const auto refusal = [this](const std::string& content, const std::string& reason) {
    return refused(query("contacts " + write("bad.csv", content)), path("bad.csv") + reason);
  };
  EXPECT_TRUE(refusal("", ": is empty"));
  EXPECT_TRUE(refusal("x,y,w\n0,0,0\n", ":1: the header is 'x,y,w', expected the columns x, y, z"));
  EXPECT_TRUE(refusal("x,y,z\n0,0,0\n", ":2: fibre '0' has only this point"));
  EXPECT_TRUE(refusal(head + "0,abc,0,0\n", ":3: x is 'abc', expected a number"));
  EXPECT_TRUE(refusal(head + "0,0,nan,0\n", ":3: y is 'nan'"));
  EXPECT_TRUE(refusal(head + "0,0,0,inf\n", ":3: z is 'inf'"));
  EXPECT_TRUE(refusal(head + "0,0,0\n", ":3: has 3 values, expected 4"));
  EXPECT_TRUE(refusal(head, ":2: fibre '0' has only this point"));
  EXPECT_TRUE(refusal(head + "0,1,0,0\n1,0,0,0\n", ":4: fibre '1' has only this point"));
  EXPECT_TRUE(refusal("fiber,x,y,z,radius\n0,0,0,0,-1\n", ":2: radius is '-1'"));
}

TEST_F(FiberQuery, OutputThatCannotBeWrittenIsAnError) {
  const ProcessResult result =
      run_process("(" FIBER_QUERY " contacts " + crossing() + " >/dev/full)");
  EXPECT_TRUE(refused(result, "cannot be written"));
}

}  // namespace
}  // namespace fiber::test

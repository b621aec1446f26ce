// fiber_query segments
#include <sstream>
#include <vector>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "src/io/number.hpp"
#include "test/support/public_edge_pairs.hpp"
#include "test/tools/tools_test.hpp"
#include "validation/geometry/hard_pairs.hpp"

namespace fiber::test {
namespace {

const std::string header = "distance,lower,upper,s,t\n";
const std::string crossing_pair = "-1,0,0,3,0,0,0,-1,2,0,1,2";

class Segments : public ToolsTest {
 protected:
  std::string answer(const std::string& content) const {
    const ProcessResult result = query("segments " + write("pairs.csv", content));
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  }
  testing::AssertionResult refusal(const std::string& content, const std::string& reason) const {
    return refused(query("segments " + write("bad.csv", content)), path("bad.csv") + reason);
  }
};

std::vector<double> numbers(const SegmentDistance& d) {
  return {d.distance, d.lower(), d.upper(), d.s, d.t};
}

TEST_F(Segments, PrintsDistanceBoundsAndParameters) {
  const std::string file = write("pairs.csv", crossing_pair + "\n");
  for (const std::string kernel : {"robust", "exact"}) {
    const ProcessResult result = query("segments " + file + " --kernel " + kernel);
    EXPECT_EQ(result.exit_code, 0);
    ASSERT_EQ(result.out.substr(0, header.size()), header);
    ASSERT_EQ(result.out.back(), '\n');
    const std::size_t length = result.out.size() - header.size() - 1;
    const std::vector<double> row = numbers_in(result.out.substr(header.size(), length));
    ASSERT_EQ(row.size(), 5U);
    EXPECT_EQ(row[0], 2.0);
    EXPECT_EQ(row[3], 0.25);
    EXPECT_EQ(row[4], 0.5);
  }
  EXPECT_EQ(query("segments " + file + " --kernel exact").out, header + "2,2,2,0.25,0.5\n");
  EXPECT_EQ(query("segments " + file).out, query("segments " + file + " --kernel robust").out);
  EXPECT_NE(query("segments " + file).out, query("segments " + file + " --kernel exact").out);
}

TEST_F(Segments, PrintsTheLibrarysNumbersBitForBit) {
  std::string content;
  std::vector<HardPair> pairs;
  for (const HardFamily& family : hard_families()) {
    for (const HardPair& pair : hard_pairs(family, 3, 1)) {
      pairs.push_back(pair);
      content += family.name;
      for (const Eigen::Vector3d& point : {pair.p0, pair.p1, pair.q0, pair.q1}) {
        for (const double coordinate : {point.x(), point.y(), point.z()}) {
          content += ',';
          append_number(content, coordinate);
        }
      }
      content += '\n';
    }
  }
  const std::string file = write("pairs.csv", content);
  for (const std::string& kernel : kernel_names()) {
    std::istringstream out(query("segments " + file + " --kernel " + kernel).out);
    std::string line;
    std::getline(out, line);
    for (const auto& [p0, p1, q0, q1, radius_a, radius_b] : pairs) {
      ASSERT_TRUE(std::getline(out, line)) << kernel;
      line.erase(0, line.find(',') + 1);  // the name
      ASSERT_EQ(numbers_in(line),
                numbers(segment_distance(kernel_from_name(kernel), p0, p1, q0, q1)))
          << kernel;
    }
    EXPECT_FALSE(std::getline(out, line)) << "a line per pair";
  }
}

TEST_F(Segments, ReadsAllThatAFileMayBe) {
  const std::string expected = answer(crossing_pair);
  EXPECT_NE(expected, header);
  for (const std::string& content :
       {crossing_pair + ",,further,7\n", "," + crossing_pair + "\n",
        std::string("-1 0 0 3 0 0 0 -1 2 0 1 2"), std::string("-1 0 0\t3 0 0 0 -1 2 0 1 2 9\n"),
        std::string("-1;0;0;3;0;0;0;-1;2;0;1;2\n"),
        std::string("# a comment\n\"-1\",\"0\",0,3,0,0,0,-1,2,0,1,2\n#-1,0,0,3,0,0,0,-1,2,0,1,2\n"),
        std::string("-1 0 0, 3 0 0, 0 -1 2, 0 1 2\n"),
        std::string(" -1 , 0 ,0 ,3,0,0,0,-1,2,0,1,2 \r\n"),
        std::string("-0x1p+0,0x0p+0,0,0x1.8p1,0,0,0,-1,0X1P1,+0,1,2\n"),
        "\n \nname,p0x,p0y,p0z,p1x,p1y,p1z,q0x,q0y,q0z,q1x,q1y,q1z\n\n" + crossing_pair + "\n\n",
        "\xEF\xBB\xBF" + crossing_pair + "\n"}) {
    EXPECT_EQ(answer(content), expected) << content;
  }
  EXPECT_EQ(answer(""), header);
  EXPECT_EQ(answer("\n\r\n"), header);
}

TEST_F(Segments, NamesOfPairsLeadTheirRows) {
  const std::string row = answer(crossing_pair).substr(header.size());
  ASSERT_GT(row.size(), 10U);
  for (const std::string separator : {",", ";", " "}) {
    std::string numbers = crossing_pair;
    std::replace(numbers.begin(), numbers.end(), ',', separator[0]);
    EXPECT_EQ(answer("edge" + separator + numbers + "\n" + numbers + "\n\"my \"\"pair\"\", 2;\"" +
                     separator + numbers + "\n"),
              "name," + header + "edge," + row + "," + row + "\"my \"\"pair\"\", 2;\"," + row)
        << separator;
  }
  EXPECT_EQ(answer("\"name\",\"p0.x\",a,b,c,d,e,f,g,h,i,j,k\n7," + crossing_pair + "\n"),
            "name," + header + "7," + row)
      << "the header says that numbers are names";
}

TEST_F(Segments, RefusesBadFilesNamingFileLineColumnAndReason) {
  const std::string good = crossing_pair + "\n\n";
  const std::string rule = ", coordinates must be finite and at most 1e150 m in magnitude";
  EXPECT_TRUE(
      refusal(good + "-1,0,0,3,0,0,0,x,2,0,1,2", ":3: column 8 (q0.y) is 'x', expected a number"));
  EXPECT_TRUE(refusal(good + "a,-1,0,0,3,0,0,0,x,2,0,1,2",
                      ":3: column 9 (q0.y) is 'x', expected a number"));
  EXPECT_TRUE(refusal("0,0,,0,0,0,0,0,0,0,0,0,0", ":1: column 3 (p0.z) is '', expected a number"));
  EXPECT_TRUE(refusal("nan,0,0,0,0,0,0,0,0,0,0,0", ":1: column 1 (p0.x) is 'nan'" + rule));
  EXPECT_TRUE(refusal("0,0,0,0,0,0,0,0,0,0,0,-inf", ":1: column 12 (q1.z) is '-inf'" + rule));
  EXPECT_TRUE(refusal("0,0,0,0,0,0,0,0,0,0,1e151,0", ":1: column 11 (q1.y) is '1e151'" + rule));
  EXPECT_TRUE(refusal("0,0,0,0,0,0,0,0,0,0,1e999,0", ":1: column 11 (q1.y) is '1e999'"));
  EXPECT_TRUE(refusal("1,2,3\n", ":1: has 3 values, expected the 12 coordinates"));
  EXPECT_TRUE(refusal("a,1,2,3,4,5,6,7,8,9,10,11\n", ":1: has 11 values after the name 'a'"));
  EXPECT_TRUE(refusal(good + "a,b,c,d,e,f,g,h,i,j,k,l,m\n", ":3: column 2 (p0.x) is 'b'"));
  EXPECT_TRUE(refusal("#a," + crossing_pair, ":1: is a comment, or a row of the name '#a'"));
  EXPECT_TRUE(refusal("a," + crossing_pair + "\n\"a," + crossing_pair,
                      ":2: value 1 has no closing quote on its line"));
  EXPECT_TRUE(refusal("\"a\"b," + crossing_pair, ":1: value 1 goes on after its closing quote"));
  EXPECT_TRUE(refused(query("segments " + path("none.csv")),
                      path("none.csv") + ": cannot be opened: No such file or directory"));
  EXPECT_TRUE(refused(query("segments /"), "/: cannot be read: Is a directory"));
}

TEST_F(Segments, RefusesBadCommandLines) {
  const std::string file = write("pairs.csv", crossing_pair);
  EXPECT_TRUE(refused(query("segments"), "FILE"));
  EXPECT_TRUE(refused(query("segments " + file + " --kernel double"),
                      "unknown kernel 'double', known are: robust, exact"));
  EXPECT_TRUE(refused(query("segments " + file + " --margin 0"), "--margin"));
}

TEST_F(Segments, AnswersThePublicEdgePairs) {
  const std::vector<EdgePair> pairs = public_edge_pairs();
  if (pairs.empty()) {
    GTEST_SKIP() << "no " << public_edge_pairs_path();
  }
  std::istringstream out(query("segments " + public_edge_pairs_path() + " --kernel exact").out);
  std::string line;
  std::getline(out, line);
  for (const EdgePair& pair : pairs) {
    ASSERT_TRUE(std::getline(out, line));
    line.erase(0, line.find(',') + 1);  // the name
    ASSERT_EQ(numbers_in(line)[0], pair.distance);
  }
}

}  // namespace
}  // namespace fiber::test

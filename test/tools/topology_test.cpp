// fiber_query crossings, linking and writhe
#include <nlohmann/json.hpp>
#include <string>

#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/query/crossings.hpp"
#include "src/io/number.hpp"
#include "test/support/curves.hpp"
#include "test/tools/tools_test.hpp"

namespace fiber::test {
namespace {

const std::string columns =
    "fiber_a,segment_a,s,fiber_b,segment_b,t,over,sign,separation,gap,point_a_x,point_a_y,"
    "point_a_z,point_b_x,point_b_y,point_b_z\n";

class Topology : public ToolsTest {
 protected:
  /// b lies over the second segment of a.
  std::string cross() const {
    return write("cross.csv",
                 "fiber,x,y,z,radius\n"
                 "0,-2,0,0,0.125\n0,-1,0,0,0.125\n0,1,0,0,0.125\n"
                 "1,0.5,-1,0.5,0.125\n1,0.5,3,0.5,0.125\n");
  }
  /// Two rings, twice around each other in frame 7 and apart in frame 9.
  std::string rings() const {
    std::string text = "frame,fiber,x,y,z\n";
    for (const int frame : {7, 9}) {
      for (const bool second : {false, true}) {
        for (Eigen::Vector3d point : torus_link(60, 2, second)) {
          point.x() += second && frame == 9 ? 10.0 : 0.0;
          text += std::to_string(frame) + (second ? ",1" : ",0");
          for (const double coordinate : {point.x(), point.y(), point.z()}) {
            text += ',';
            append_number(text, coordinate);
          }
          text += '\n';
        }
      }
    }
    return write("rings.csv", text);
  }
  std::string answer(const std::string& arguments) const {
    const ProcessResult result = query(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err, "");
    return result.out;
  }
};

TEST_F(Topology, CrossingsFromAboveBelowAsideAndFromAnEye) {
  const std::string crossings = "crossings " + cross();
  const std::string where = "0,1,0.75,1,0,0.25,";
  const std::string rest = ",-1,0.5,0.25,0.5,0,0,0.5,0,0.5\n";
  EXPECT_EQ(answer(crossings), columns + where + "b" + rest);
  EXPECT_EQ(answer(crossings + " --direction 0,0,-3"), columns + where + "b" + rest);
  EXPECT_EQ(answer(crossings + " --direction 0,0,1"), columns + where + "a" + rest);
  EXPECT_EQ(answer(crossings + " --direction -1,0,0"), columns);
  EXPECT_EQ(answer(crossings + " --eye 0.5,0,1 --threads 1"), columns + where + "b" + rest);
  EXPECT_EQ(answer(crossings + " --eye 0.5,0,-1"), columns);
  EXPECT_EQ(answer(crossings + " --eye 0.5,0,-1 --direction 0,0,1"), columns + where + "a" + rest);
}

TEST_F(Topology, CrossingsAsJson) {
  const auto object = nlohmann::json::parse(answer("crossings " + cross() + " --format json"));
  ASSERT_EQ(object.at("crossings").size(), 1U);
  const nlohmann::json& crossing = object["crossings"][0];
  EXPECT_EQ(crossing.at("fiber_b"), 1);
  EXPECT_EQ(crossing.at("s"), 0.75);
  EXPECT_EQ(crossing.at("over"), "b");
  EXPECT_EQ(crossing.at("sign"), -1);
  EXPECT_EQ(crossing.at("gap"), 0.25);
  EXPECT_EQ(crossing.at("point_b"), nlohmann::json({0.5, 0.0, 0.5}));
  EXPECT_FALSE(object.contains("frame"));
}

TEST_F(Topology, LinkingNumbersOfEachFrame) {
  EXPECT_EQ(answer("linking " + rings()), "frame,fiber_a,fiber_b,linking_number\n7,0,1,2\n");
  EXPECT_EQ(answer("linking " + rings() + " --format json"),
            "{\"frame\":7,\"linking_numbers\":[{\"fiber_a\":0,\"fiber_b\":1,\"linking_number\":2}]}"
            "\n{\"frame\":9,\"linking_numbers\":[]}\n");
  EXPECT_EQ(answer("linking " + cross()), "fiber_a,fiber_b,linking_number\n");
}

TEST_F(Topology, WrithesOfOpenAndClosedFibres) {
  const auto expected = [](CurveEnds ends) {
    std::string text = "frame,fiber,writhe\n";
    for (const char* frame : {"7", "9"}) {
      for (const bool second : {false, true}) {
        Curve curve = torus_link(60, 2, second);
        if (second && *frame == '9') {
          curve = mapped(curve, [](const Eigen::Vector3d& p) {
            return Eigen::Vector3d(p.x() + 10.0, p.y(), p.z());
          });
        }
        text += std::string(frame) + (second ? ",1," : ",0,");
        append_number(text, writhe(curve, ends));
        text += '\n';
      }
    }
    return text;
  };
  EXPECT_EQ(answer("writhe " + rings()), expected(CurveEnds::OPEN));
  EXPECT_EQ(answer("writhe " + rings() + " --closed"), expected(CurveEnds::CLOSED));
  EXPECT_EQ(answer("writhe " + cross() + " --format json"),
            "{\"writhes\":[{\"fiber\":0,\"writhe\":0.0},{\"fiber\":1,\"writhe\":0.0}]}\n");
}

TEST_F(Topology, RefusesBadInput) {
  const std::string crossings = "crossings " + cross();
  for (const std::string text : {"1,2", "1,2,3,4", "1,,3", "a,b,c", "nan,0,0", "0,inf,0"}) {
    EXPECT_TRUE(refused(query(crossings + " --direction " + text),
                        "--direction: '" + text + "' must be three numbers X,Y,Z"));
    EXPECT_TRUE(refused(query(crossings + " --eye " + text), "--eye: '" + text + "' must be"));
  }
  EXPECT_TRUE(refused(query(crossings + " --direction 0,0,0"), "it must have a length"));
  EXPECT_TRUE(refused(query(crossings + " --margin 1"), "--margin"));
  EXPECT_TRUE(refused(query(crossings + " --format xml"), "--format"));
  EXPECT_TRUE(refused(query(crossings + " --threads -1"), "--threads"));
  EXPECT_TRUE(refused(query("crossings"), "FILE is required"));
  EXPECT_TRUE(refused(query("linking " + cross() + " --closed"), "--closed"));
  const std::string missing = path("missing.csv");
  const std::string broken = write("broken.csv", "fiber,x,y,z\na,0,0,0\na,0,0,nan\n");
  for (const std::string command : {"crossings ", "linking ", "writhe "}) {
    EXPECT_TRUE(refused(query(command + missing), missing));
    EXPECT_TRUE(refused(query(command + broken), broken + ":3"));
  }
}

}  // namespace
}  // namespace fiber::test

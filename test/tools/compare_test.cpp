// fiber_query compare
#include <nlohmann/json.hpp>
#include <sstream>

#include "test/tools/tools_test.hpp"

namespace fiber::test {
namespace {

class Compare : public ToolsTest {
 protected:
  std::string cables() const {
    const ProcessResult made = scene("cables --frames 3 --out " + path("cables.csv"));
    EXPECT_EQ(made.exit_code, 0) << made.err;
    return path("cables.csv");
  }
  /// Crossing segments of a tenth of a micrometre, which FCL takes for parallel.
  std::string tiny() const {
    return write("tiny.csv",
                 "fiber,x,y,z\n0,-5e-8,0,0\n0,5e-8,0,0\n1,0,-5e-8,2e-8\n1,0,5e-8,2e-8\n");
  }
  static std::vector<nlohmann::json> frames(const ProcessResult& result) {
    EXPECT_EQ(result.exit_code, 0) << result.err;
    std::vector<nlohmann::json> objects;
    std::istringstream stream(result.out);
    for (std::string line; std::getline(stream, line);) {
      objects.push_back(nlohmann::json::parse(line));
    }
    return objects;
  }
};

TEST_F(Compare, AgreesOnCables) {
  const std::vector<nlohmann::json> found =
      frames(query("compare " + cables() + " --margin 0.01 --format json"));
  ASSERT_EQ(found.size(), 3U);
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].at("frame"), i);
    EXPECT_EQ(found[i].at("ours_is_right"), true);
    const nlohmann::json& ours = found[i].at("ours");
    EXPECT_GT(ours.at("contacts"), 0);
    EXPECT_GT(ours.at("update_time"), 0.0);
    EXPECT_GT(ours.at("detect_time"), 0.0);
    ASSERT_EQ(found[i].at("fcl").size(), 2U);
    for (const nlohmann::json& fcl : found[i].at("fcl")) {
      EXPECT_EQ(fcl.at("contacts"), ours.at("contacts"));
      EXPECT_EQ(fcl.at("in_both"), ours.at("contacts"));
      EXPECT_EQ(fcl.at("disagreements").size(), 0U);
      EXPECT_GT(fcl.at("update_time"), 0.0);
      EXPECT_GT(fcl.at("detect_time"), 0.0);
    }
    EXPECT_EQ(found[i].at("fcl")[0].at("style"), "user");
    EXPECT_EQ(found[i].at("fcl")[1].at("style"), "best");
  }
}

TEST_F(Compare, ShowsWhoIsRight) {
  const std::vector<nlohmann::json> found =
      frames(query("compare " + tiny() + " --radius 1.1e-8 --format json"));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_FALSE(found[0].contains("frame")) << "the file numbers none";
  const nlohmann::json& user = found[0].at("fcl").at(0);
  EXPECT_EQ(user.at("only_ours"), 1);
  const nlohmann::json& pair = user.at("disagreements").at(0);
  EXPECT_EQ(pair.at("fiber_a"), 0);
  EXPECT_EQ(pair.at("fiber_b"), 1);
  EXPECT_NEAR(pair.at("ours"), -2e-9, 1e-22);
  EXPECT_EQ(pair.at("fcl"), nullptr);
  EXPECT_EQ(pair.at("fcl_has_answer"), true);
  EXPECT_EQ(pair.at("is_contact"), true);
  EXPECT_EQ(pair.at("verdict"), "ours");
}

TEST_F(Compare, IsReadableByDefault) {
  const ProcessResult result = query("compare " + tiny() + " --radius 1.1e-8");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const char* const summary =
      "\n1 frame, 1 disagreements: ours is right in 1, FCL in 0, none in 0, within what both are "
      "rounded by 0\n";
  for (const char* part :
       {"  ours: 1 contacts, update ", "  FCL, user style: 0 contacts, update ",
        "; only ours 1, only FCL 0, in both 0, no answer 0\n", "    0/0 - 1/0: ours -1.99",
        " m, FCL no contact, true gap -1.99", " m (contact): ours is right\n",
        "  FCL, best style: 1 contacts, update ", summary}) {
    EXPECT_NE(result.out.find(part), std::string::npos) << part << "\nin\n" << result.out;
  }
  EXPECT_EQ(query("compare " + cables()).out.substr(0, 8), "frame 0\n");
}

TEST_F(Compare, WritesALinePerFrameAndMethod) {
  const ProcessResult result = query("compare " + cables() + " --format csv");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::istringstream stream(result.out);
  std::string line;
  std::getline(stream, line);
  EXPECT_EQ(line,
            "frame,method,update_time,detect_time,pair_tests,contacts,only_ours,only_fcl,in_both,"
            "no_answer,largest_difference,right_both,right_ours,right_fcl,right_neither");
  const auto commas = std::count(line.begin(), line.end(), ',');
  for (const char frame : {'0', '1', '2'}) {
    for (const char* method : {",ours,", ",fcl_user,", ",fcl_best,"}) {
      ASSERT_TRUE(std::getline(stream, line));
      EXPECT_EQ(line.find(frame + std::string(method)), 0U) << line;
      EXPECT_EQ(std::count(line.begin(), line.end(), ','), commas) << line;
    }
  }
  EXPECT_FALSE(std::getline(stream, line));
}

TEST_F(Compare, TakesTheKernel) {
  const std::vector<nlohmann::json> found =
      frames(query("compare " + tiny() + " --radius 1.1e-8 --format json --kernel exact"));
  EXPECT_EQ(found.at(0).at("fcl").at(0).at("disagreements").size(), 1U);
}

TEST_F(Compare, RefusesBadInput) {
  const std::string file = tiny();
  EXPECT_TRUE(refused(query("compare"), "FILE"));
  EXPECT_TRUE(refused(query("compare " + path("none.csv")), "none.csv: cannot be opened"));
  EXPECT_TRUE(refused(query("compare " + file + " --margin inf"), "--margin"));
  EXPECT_TRUE(refused(query("compare " + file + " --margin -1"), "--margin"));
  EXPECT_TRUE(refused(query("compare " + file + " --neighbour-skip -1"), "--neighbour-skip"));
  EXPECT_TRUE(refused(query("compare " + file + " --engine octree"), "unknown engine 'octree'"));
  EXPECT_TRUE(refused(query("compare " + file + " --format xml"), "--format"));
  EXPECT_TRUE(refused(query("compare " + file + " --kernel double"), "unknown kernel 'double'"));
}

}  // namespace
}  // namespace fiber::test

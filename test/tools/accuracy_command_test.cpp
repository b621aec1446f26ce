// fiber_query accuracy
#include <nlohmann/json.hpp>
#include <string>

#include "test/tools/fiber_query.hpp"

namespace fiber::test {
namespace {

class Accuracy : public FiberQuery {
 protected:
  /// Cables with contacts in each frame.
  std::string cables() const {
    EXPECT_EQ(scene("cables --frames 25 --out " + path("cables.csv")).exit_code, 0);
    return path("cables.csv");
  }
};

TEST_F(Accuracy, EndsWithARecommendation) {
  const ProcessResult result = query("accuracy " + cables() + " --seconds 600 --answers 25");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::string last = lines(result.out).back();
  EXPECT_EQ(last.rfind("all: take ", 0), 0U) << last;
  EXPECT_NE(last.find(" ms"), std::string::npos) << last;
  EXPECT_NE(last.find("noise"), std::string::npos) << last;
}

TEST_F(Accuracy, SaysWhoseTheDoubtIs) {
  const ProcessResult result =
      query("accuracy " + cables() + " --seconds 600 --answers 25 --questions all --noise 0.002");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("doubt about a gap: tracker 16 mm, latency of a frame "),
            std::string::npos)
      << result.out;
  EXPECT_NE(result.out.find("tell the node: uncertainty: 0.008 [m]"), std::string::npos);
}

TEST_F(Accuracy, CsvHasARowForEachQuestionAndSetting) {
  const ProcessResult result =
      query("accuracy " + cables() + " --seconds 600 --answers 25 --format csv --noise 0.002");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::vector<std::string> rows = lines(result.out);
  EXPECT_EQ(rows.front().rfind("question,setting,kind,kernel,tolerance,", 0), 0U);
  const auto count = [&](const std::string& begin) {
    return std::count_if(rows.begin(), rows.end(),
                         [&](const std::string& row) { return row.rfind(begin, 0) == 0; });
  };
  for (const std::string question : {"all", "closest", "fiber_pairs", "limited", "first"}) {
    EXPECT_EQ(count(question + ",robust,kernel,"), 1);
    EXPECT_EQ(count(question + ",exact,kernel,"), 1);
    EXPECT_EQ(count(question + ",deadline at "), 3);
    EXPECT_EQ(count(question + ",skin of "), 2);
    EXPECT_EQ(count(question + ",no skin,"), 1);
  }
  EXPECT_EQ(count("closest,tolerance of "), 4);
  EXPECT_EQ(count("all,tolerance of "), 0);
  EXPECT_GE(count("fiber_pairs,resampled to "), 1);
  EXPECT_EQ(rows.back().rfind("# all: take ", 0), 0U) << rows.back();
  EXPECT_NE(rows.back().find("your tracker's noise of 2 mm"), std::string::npos);
}

TEST_F(Accuracy, JsonIsOneObject) {
  const ProcessResult result =
      query("accuracy " + cables() +
            " --seconds 600 --answers 25 --format json --questions closest --rate 50"
            " --engines brute_force,AL --margin 0.01");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json report = nlohmann::json::parse(result.out);
  EXPECT_EQ(report["frames"], 25);
  EXPECT_EQ(report["margin"], 0.01);
  EXPECT_EQ(report["frame_time"], 0.02);
  EXPECT_TRUE(report["noise"].is_number());
  int recommended = 0;
  for (const nlohmann::json& row : report["settings"]) {
    EXPECT_EQ(row["question"], "closest");
    EXPECT_TRUE(row["bounds_kept_percent"].is_null() || row["bounds_kept_percent"] == 100.0);
    recommended += row["recommended"].get<bool>() ? 1 : 0;
    EXPECT_FALSE(row["recommended"].get<bool>() && row["dominated"].get<bool>());
  }
  EXPECT_EQ(recommended, 1);
  const std::string sentence = report["recommendation"];
  EXPECT_EQ(sentence.rfind("closest: take ", 0), 0U);
}

TEST_F(Accuracy, DrawsAPictureThatIsXml) {
  const std::string picture = path("picture.svg");
  const ProcessResult result =
      query("accuracy " + cables() +
            " --seconds 600 --answers 25 --rate 30 --noise 0.001 --picture " + picture);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const ProcessResult titles = run_process(
      "python3 -c \"import xml.etree.ElementTree as e; print(*(t.text for t in "
      "e.parse('" +
      picture + "').iter('{http://www.w3.org/2000/svg}title')), sep='\\n')\"");
  EXPECT_EQ(titles.exit_code, 0) << titles.err;
  for (const std::string name : {"robust:", "exact:", "tolerance of 10 mm:", "deadline at 25 %:",
                                 "skin of ", "resampled to 10 mm:", "settings"}) {
    EXPECT_NE(titles.out.find(name), std::string::npos) << name << titles.out;
  }
}

TEST_F(Accuracy, OneFrameIsMeasuredAndWhatItDoesNotTellIsTold) {
  const ProcessResult result = query("accuracy " + crossing() + " --seconds 600 --answers 25");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(
      result.err.find("has one frame: the tracker's noise and what a skin saves cannot be told"),
      std::string::npos);
  EXPECT_NE(result.out.find("noise not known: there are fewer than three frames"),
            std::string::npos);
  EXPECT_NE(lines(result.out).back().find("noise is not known"), std::string::npos);
}

TEST_F(Accuracy, RefusesWhatCannotBeMeasured) {
  const std::string accuracy = "accuracy ";
  EXPECT_TRUE(refused(query(accuracy + crossing() + " --margin 0.01"),
                      "nothing comes within a margin of 10 mm in 1 frame, the nearest pair to "
                      "100 mm; try --margin 0.2"));
  EXPECT_TRUE(refused(query(accuracy + write("empty.csv", "frame,x,y,z\n")), "empty.csv"));
  const std::string straight =
      write("straight.csv", "x,y,z,radius\n0,0,0,0.1\n1,0,0,0.1\n2,0,0,0.1\n");
  EXPECT_TRUE(refused(query(accuracy + straight), "has no pair of segments in 1 frame"));
  EXPECT_TRUE(refused(query(accuracy + crossing() + " --picture /nowhere/picture.svg"),
                      "/nowhere/picture.svg: cannot be opened"));
  EXPECT_TRUE(refused(query(accuracy + crossing() + " --picture picture.png"),
                      "--picture is 'picture.png', its name must end in .svg"));
  EXPECT_TRUE(refused(query(accuracy + crossing() + " --engines XL"), "'XL'"));
  EXPECT_TRUE(refused(query(accuracy + crossing() + " --questions nearest"), "nearest"));
  EXPECT_TRUE(
      refused(query(accuracy + crossing() + " --questions all,first,all"), "'all' is there twice"));
  EXPECT_TRUE(refused(query(accuracy + crossing() + " --rate 0"), "--rate"));
  EXPECT_TRUE(refused(query(accuracy + crossing() + " --noise -1"), "--noise"));
  EXPECT_TRUE(refused(query(accuracy + path("none.csv")), "cannot be opened"));
}

}  // namespace
}  // namespace fiber::test

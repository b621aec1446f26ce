// fiber_bench kernels and motions
#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "test/benchmark/fiber_bench.hpp"

namespace fiber::test {
namespace {

TEST_F(FiberBench, JudgesKernelsOnHardPairs) {
  const ProcessResult result = bench("kernels --json --pairs 3 --repeats 1 --kernels robust,exact");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "") << "progress is for terminals";
  const std::vector<nlohmann::json> rows = json_lines(result.out);
  const std::vector<std::string> kernels{"robust", "exact"};
  ASSERT_GT(rows.size(), 3U * 50U);
  ASSERT_EQ(rows.size() % kernels.size(), 0U);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    SCOPED_TRACE(rows[i].dump());
    EXPECT_EQ(rows[i].at("kernel"), kernels[i % kernels.size()]);
    EXPECT_EQ(rows[i].at("family"), rows[i - i % kernels.size()].at("family"));
    EXPECT_EQ(rows[i].at("answered"), 3);
    for (const char* const field :
         {"missed", "outside_bounds", "not_finite", "no_answer", "ended"}) {
      EXPECT_EQ(rows[i].at(field), 0) << field;
    }
    EXPECT_EQ(rows[i].at("false"), 0);
    EXPECT_LT(rows[i].at("error_units"), 4.0);
    EXPECT_GT(rows[i].at("p99_ns"), 0.0);
    EXPECT_GE(rows[i].at("p99_ns"), rows[i].at("p50_ns"));
  }
}

TEST_F(FiberBench, PrintsATableOfKernelsWithoutJson) {
  const ProcessResult result =
      bench("kernels --pairs 3 --repeats 1 --kernels robust --families collinear,generic --seed 5");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 3) << result.out;
  for (const char* const word : {"error [eps*M]", "collinear", "generic", "robust"}) {
    EXPECT_NE(result.out.find(word), std::string::npos) << result.out;
  }
}

TEST_F(FiberBench, JudgesContactTimesOfHardMotions) {
  const ProcessResult result = bench(
      "motions --parts accuracy --count 110 --threads 2 --tolerances 1e-3,1e-9 --seed 2 --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "") << "progress is for terminals";
  const std::vector<nlohmann::json> rows = json_lines(result.out);
  ASSERT_GT(rows.size(), 2U * 20U);
  for (const nlohmann::json& row : rows) {
    SCOPED_TRACE(row.dump());
    EXPECT_EQ(row.at("part"), "accuracy");
    const bool has_thickness = row.at("family").get<std::string>().rfind("crossing", 0) != 0;
    EXPECT_EQ(row.at("motions"), has_thickness ? 110 : 2);
    for (const char* const field : {"misses", "false_alarms", "wrongly_certain", "wide"}) {
      EXPECT_EQ(row.at(field), 0) << field;
    }
    EXPECT_EQ(row.at("wrong").size(), 0U);
  }
}

TEST_F(FiberBench, MeasuresContactTimesInTurns) {
  const ProcessResult result = bench(
      "motions --parts times --families random 'grazing, translating' --timed 50 --repeats 2 "
      "--kernels own,own_single,discrete_10 --tolerances 1e-6,1e-9 --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::vector<nlohmann::json> rows = json_lines(result.out);
  ASSERT_EQ(rows.size(), 2U * 4U);
  const std::vector<std::string> kernels{"own", "own", "own_single", "discrete_10"};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    SCOPED_TRACE(rows[i].dump());
    EXPECT_EQ(rows[i].at("kernel"), kernels[i % kernels.size()]);
    EXPECT_EQ(rows[i].at("tolerance"), i % kernels.size() == 1 ? 1e-9 : 1e-6);
    EXPECT_EQ(rows[i].at("answered"), 50);
    EXPECT_GT(rows[i].at("hit_ns"), 0.0);
    EXPECT_EQ(rows[i].at("rejected_ns").is_null(), rows[i].at("rejected") == 0);
    if (kernels[i % kernels.size()] != "discrete_10") {
      EXPECT_EQ(rows[i].at("misses"), 0);
      EXPECT_EQ(rows[i].at("early"), 0);
    }
    EXPECT_EQ(rows[i].at("false_alarms"), 0);
  }
  EXPECT_GT(rows.back().at("misses"), 0) << "some only graze each other";
}

/// In the soup fibres come into contact and part again within a step.
TEST_F(FiberBench, LooksAtScenesWhoseFibersMove) {
  const ProcessResult result = bench(
      "motions --parts scenes --scenes soup --scale 0.02 --ways 1,30 --repeats 2 --seed 3 --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::vector<nlohmann::json> rows = json_lines(result.out);
  const std::vector<std::string> methods{"discrete_1", "discrete_10", "discrete_100", "motion_all",
                                         "motion_first"};
  ASSERT_EQ(rows.size(), 2 * methods.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    SCOPED_TRACE(rows[i].dump());
    const std::string& method = methods[i % methods.size()];
    const bool looks_once = method != "discrete_10" && method != "discrete_100";
    EXPECT_EQ(rows[i].at("method"), method);
    EXPECT_EQ(rows[i].at("way"), i < methods.size() ? 1.0 : 30.0);
    EXPECT_EQ(rows[i].at("frames"), looks_once ? 2 : 1);
    EXPECT_GT(rows[i].at("time_ms"), 0.0);
    EXPECT_GT(rows[i].at("times_discrete"), 0.0);
    EXPECT_EQ(rows[i].at("missed").is_null(), method == "motion_first");
  }
  const nlohmann::json& all = rows[8];
  EXPECT_GT(all.at("contacts"), 0);
  EXPECT_EQ(all.at("missed"), 0);
  EXPECT_GE(all.at("candidates"), all.at("contacts"));
  EXPECT_GT(rows[5].at("missed"), 0) << "one look at the end of a long way";
}

TEST_F(FiberBench, HoldsContactTimesAgainstAFileOfKnownMotions) {
  // The second of two segments at right angles comes down upon the first; or not.
  const std::string start =
      "0x0p0,0x0p0,0x0p0,0x1p0,0x0p0,0x0p0,0x1p-1,-0x1p0,0x1p0,0x1p-1,0x1p0,0x1p0,";
  const std::string still = "0x0p0,0x0p0,0x0p0,0x1p0,0x0p0,0x0p0,";
  const std::string file = write(
      "motions.csv", "walls,1," + start + still + "0x1p-1,-0x1p0,-0x1p0,0x1p-1,0x1p0,-0x1p0\n" +
                         "walls,0," + start + still + "0x1p-1,-0x1p0,0x1p-1,0x1p-1,0x1p0,0x1p-1\n");
  const ProcessResult result = bench("motions --parts known --tolerances 1e-6 --known " + file);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const nlohmann::json row =
      json_lines(bench("motions --json --parts known --tolerances 1e-6 --known " + file).out).at(0);
  EXPECT_EQ(row.at("motions"), 2);
  EXPECT_EQ(row.at("contacts"), 1);
  EXPECT_EQ(row.at("hits"), 1);
  EXPECT_EQ(row.at("contacts_missed"), 0);
  EXPECT_EQ(row.at("contacts_invented"), 0);
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 3) << result.out;
  const nlohmann::json timed =
      json_lines(bench("motions --json --parts times --kernels own,discrete_1 --families random "
                       "--timed 5 --repeats 1 --tolerances 1e-6 --known " +
                       file)
                     .out);
  ASSERT_EQ(timed.size(), 4U) << timed;
  EXPECT_EQ(timed[0].at("family"), "known");
  EXPECT_EQ(timed[0].at("motions"), 2);
  EXPECT_EQ(timed[0].at("contacts"), 1);
  EXPECT_EQ(timed[0].at("misses"), 0);
  EXPECT_EQ(timed[1].at("misses"), 1) << "one look at the end";
  EXPECT_EQ(timed[2].at("family"), "random");
  // One whose truth is wrong.
  const std::string wrong =
      write("wrong.csv", "walls,1," + start + still + "0x1p-1,-0x1p0,0x1p-1,0x1p-1,0x1p0,0x1p-1\n");
  EXPECT_EQ(json_lines(bench("motions --json --parts known --known " + wrong).out)
                .at(0)
                .at("contacts_missed"),
            1);
  EXPECT_TRUE(refused(bench("motions --parts known --known " + path("none.csv")), "none.csv"));
}

}  // namespace
}  // namespace fiber::test

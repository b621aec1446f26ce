// fiber_bench environment
#include <nlohmann/json.hpp>
#include <vector>

#include "test/benchmark/fiber_bench.hpp"

namespace fiber::test {
namespace {

/// The links are coarse: what matters is that both find the same.
TEST_F(FiberBench, ChecksACellBesideFcl) {
  const ProcessResult result =
      bench("environment --parts cell --triangles 200 --repeats 4 --threads 2 --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "") << "progress is for terminals";
  const std::vector<nlohmann::json> rows = json_lines(result.out);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].at("checker"), "own");
  EXPECT_EQ(rows[1].at("checker"), "fcl");
  EXPECT_EQ(rows[0].at("times_own"), 1.0);
  EXPECT_GT(rows[1].at("times_own"), 0.0);
  for (const nlohmann::json& row : rows) {
    SCOPED_TRACE(row.dump());
    EXPECT_EQ(row.at("segments"), 990);
    EXPECT_EQ(row.at("objects"), 28);
    for (const char* const field :
         {"objects_ms", "cables_ms", "self_ms", "contacts_ms", "nearest_ms"}) {
      EXPECT_GT(row.at(field), 0.0) << field;
      EXPECT_LE(row.at(field), row.at("sum_ms")) << field;
    }
    EXPECT_GT(row.at("self_contacts"), 0);
    EXPECT_GT(row.at("contacts"), 0);
    EXPECT_EQ(row.at("self_contacts"), rows[0].at("self_contacts"));
    EXPECT_NEAR(row.at("nearest"), 0.002, 1e-6) << "cables lie so far above the table";
    EXPECT_LT(row.at("nearest_error"), 1e-6);
    EXPECT_EQ(row.at("unwanted"), 0);
    EXPECT_EQ(row.at("exceptions"), 0);
  }
}

TEST_F(FiberBench, ChecksACellAloneInFramesThatFollowEachOther) {
  const ProcessResult result = bench(
      "environment --parts cell --triangles 200 --repeats 3 --without-fcl --frames-per-sway 1320 "
      "--json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::vector<nlohmann::json> rows = json_lines(result.out);
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_EQ(rows[0].at("checker"), "own");
  EXPECT_GT(rows[0].at("contacts"), 0);
  EXPECT_NEAR(rows[0].at("motion"), 0.02, 0.002) << "of a segment, of the fastest point";
}

TEST_F(FiberBench, MakesOctreesOfACameraAndChecksABatch) {
  const ProcessResult result = bench(
      "environment --parts batch,octree --pixels 3000 --candidates 40 --points 20 --triangles 200 "
      "--repeats 2 --threads 2 --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::vector<nlohmann::json> rows = json_lines(result.out);
  ASSERT_EQ(rows.size(), 4U);
  for (const std::size_t i : {0U, 1U}) {
    EXPECT_EQ(rows[i].at("part"), "octree");
    EXPECT_GT(rows[i].at("build_ms"), 0.0);
    EXPECT_LE(rows[i].at("cells"), 3000);
    EXPECT_EQ(rows[i + 2].at("part"), "batch");
    EXPECT_EQ(rows[i + 2].at("threads"), i + 1);
    EXPECT_GT(rows[i + 2].at("per_candidate_ms"), 0.0);
    EXPECT_GT(rows[i + 2].at("touching"), 0);
    EXPECT_LT(rows[i + 2].at("touching"), 40);
  }
  EXPECT_GT(rows[0].at("cells"), rows[1].at("cells")) << "the larger ones come second";
  EXPECT_EQ(rows[2].at("touching"), rows[3].at("touching"));
}

TEST_F(FiberBench, PrintsTablesOfTheEnvironmentWithoutJson) {
  const ProcessResult result = bench(
      "environment --cables 1 --points 9 --triangles 20 --pixels 100 --candidates 2 --repeats 1");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* const word : {"cell", "times_own", "fcl", "build_ms", "per_candidate_ms"}) {
    EXPECT_NE(result.out.find(word), std::string::npos) << result.out;
  }
}

}  // namespace
}  // namespace fiber::test

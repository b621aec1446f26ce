#include "test/benchmark/fiber_bench.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <vector>

namespace fiber::test {
namespace {

TEST_F(FiberBench, EnginesAgreeOnEverySubcommand) {
  // Of this seed, two fibres touch in frame 2.
  for (const std::string command : {"update", "cycle"}) {
    SCOPED_TRACE(command);
    const ProcessResult result =
        bench(command +
              " --scene soup --scale 0.004 --seed 2 --repeats 2 --engines AL,brute_force --json");
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.err, "") << "progress is for terminals";
    const std::vector<nlohmann::json> rows = json_lines(result.out);
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0].at("engine"), "AL");
    EXPECT_EQ(rows[1].at("engine"), "brute_force");
    for (const nlohmann::json& row : rows) {
      EXPECT_EQ(row.at("scene"), "soup");
      EXPECT_EQ(row.at("segments"), 4000);
      EXPECT_EQ(row.at("threads"), 1);
      EXPECT_GT(row.at("detect_ms"), 0.0);
      EXPECT_GE(row.at("cycle_ms"), row.at("detect_ms"));
      EXPECT_GT(row.at("memcpy_ms"), 0.0);
      EXPECT_EQ(row.at("update_per_memcpy"),
                row.at("update_ms").get<double>() / row.at("memcpy_ms").get<double>());
      EXPECT_EQ(row.at("pairs"), rows[0].at("pairs"));
      EXPECT_GT(row.at("pairs"), 0);
      EXPECT_GT(row.at("primitive_tests"), 0);
    }
    EXPECT_GT(rows[0].at("update_ms"), 0.0);
    EXPECT_GT(rows[0].at("node_tests"), rows[0].at("node_overlaps"));
    EXPECT_EQ(rows[1].at("node_tests"), 0);
    EXPECT_LT(rows[0].at("primitive_tests"), rows[1].at("primitive_tests"));
  }
}

TEST_F(FiberBench, CopiesOfASceneAreAsDenseAsOne) {
  // Frame 1 is so near to frame 0 that no copy has moved into another.
  const std::string command =
      "cycle --scene tress_b --scale 0.01 --repeats 1 --json --engines run_tree,AL --copies ";
  const nlohmann::json one = json_lines(bench(command + "1").out).at(0);
  const std::vector<nlohmann::json> rows = json_lines(bench(command + "10").out);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_GT(one.at("pairs"), 0);
  for (const nlohmann::json& row : rows) {
    for (const char* const field : {"fibers", "points", "segments", "pairs"}) {
      EXPECT_EQ(row.at(field), 10 * one.at(field).get<std::uint64_t>()) << field;
    }
    EXPECT_EQ(row.at("copies"), 10);
  }
}

TEST_F(FiberBench, AsksForTheClosestPairWhereThereIsNoContact) {
  const std::string command = "cycle --scene soup --scale 0.0002 --repeats 1 --engines ";
  const ProcessResult result = bench(command + "run_tree,AL --closest --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json_lines(result.out).at(0).at("pairs"), 0);
  // A peer gives away that it is asked: it cannot answer.
  if (bench(command + "bullet").exit_code != 0) {
    GTEST_SKIP() << "Bullet is not installed";
  }
  const ProcessResult refused = bench(command + "bullet --closest");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("a peer answers only ALL"), std::string::npos) << refused.err;
}

TEST_F(FiberBench, PrintsATableWithoutJson) {
  const ProcessResult result = bench("cycle --scale 0.001 --repeats 1");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("update [ms]"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("run_tree"), std::string::npos) << result.out;
}

TEST_F(FiberBench, PrintsStageAfterStage) {
  const std::string command = "stages --scene soup --scale 0.004 --engine SW --trials 3 ";
  const ProcessResult result = bench(command + "--levels --shuffle --no-leaf-pretest");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::vector<nlohmann::json> rows = json_lines(result.out);
  const std::vector<std::string> stages{"build", "update", "levels", "first", "detect"};
  ASSERT_EQ(rows.size(), stages.size());
  for (std::size_t i = 0; i < stages.size(); ++i) {
    EXPECT_EQ(rows[i].at("stage"), stages[i]);
    EXPECT_EQ(rows[i].at("segments"), 4000);
    EXPECT_EQ(rows[i].at("shuffle"), true);
    EXPECT_EQ(rows[i].at("leaf_pretest"), false);
  }
  EXPECT_GT(rows[1].at("ns_per_segment"), 0.0);
  EXPECT_GT(rows[1].at("bytes_per_segment"), 0.0);
  EXPECT_LT(rows[1].at("recomputed_per_segment"), 2.0) << "cascade verification keeps some";
  const std::vector<double> volumes = rows[2].at("mean_volumes");
  EXPECT_EQ(volumes.size(), 13U);  // 2¹² leaves' worth
  EXPECT_GT(volumes.front(), volumes.back());
  EXPECT_EQ(rows[3].at("trials"), 3);
  EXPECT_GT(rows[4].at("detect_ms"), 0.0);
  EXPECT_EQ(json_lines(bench(command + "--until update").out).size(), 2U);
}

TEST_F(FiberBench, ASkinKeepsTheTreeForAsManyFramesAsItLasts) {
  const ProcessResult result = bench(
      "coherence --scene curly --scale 0.001 --frames 12 --motion 0.1 --skins 0,0.1,0.6 --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "") << "progress is for terminals";
  const std::vector<nlohmann::json> rows = json_lines(result.out);
  ASSERT_EQ(rows.size(), 3U);
  const std::vector<double> skins{0.0, 0.1, 0.6};
  // Two points may have come nearer by twice the motion: 0.1 does not last one frame, 0.6 three.
  const std::vector<int> refits{12, 12, 3};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(rows[i].at("scene"), "curly");
    EXPECT_EQ(rows[i].at("engine"), "run_tree");
    EXPECT_EQ(rows[i].at("segments"), 4700);
    EXPECT_EQ(rows[i].at("threads"), 1);
    EXPECT_EQ(rows[i].at("motion"), 0.1);
    EXPECT_EQ(rows[i].at("skin_lengths"), skins[i]);
    EXPECT_EQ(rows[i].at("skin"), skins[i] * rows[i].at("segment_length").get<double>());
    EXPECT_GT(rows[i].at("segment_length"), 0.0);
    EXPECT_EQ(rows[i].at("refits"), refits[i]) << i;
    EXPECT_GT(rows[i].at("detect_ms"), 0.0);
    EXPECT_EQ(rows[i].at("cycle_ms"),
              rows[i].at("update_ms").get<double>() + rows[i].at("detect_ms").get<double>());
    EXPECT_GT(rows[i].at("pairs"), 0);
    EXPECT_EQ(rows[i].at("pairs"), rows[0].at("pairs"));
  }
}

TEST_F(FiberBench, ASkinKeepsTheCandidatesOfFibersThatStandStill) {
  const ProcessResult result = bench(
      "coherence --scene curly --scale 0.001 --frames 6 --motion 0.1 --moving 0.1 --skins 0,0.01 "
      "--json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::vector<nlohmann::json> rows = json_lines(result.out);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0].at("partial"), 0);
  EXPECT_EQ(rows[1].at("partial"), 6);
  EXPECT_EQ(rows[1].at("moving"), 0.1);
  EXPECT_EQ(rows[1].at("pairs"), rows[0].at("pairs"));
}

TEST_F(FiberBench, PrintsATableOfSkinsWithoutJson) {
  const ProcessResult result = bench("coherence --scale 0.001 --frames 1 --skins 0.1");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("skin [m]"), std::string::npos) << result.out;
}

TEST_F(FiberBench, SaysWhatAccuracyCostsAndBrings) {
  const ProcessResult result =
      bench("accuracy --scene tress_a --scale 0.01 --repeats 2 --threads 2 --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::vector<nlohmann::json> rows = json_lines(result.out);
  ASSERT_GT(rows.size(), 15U);
  for (const nlohmann::json& row : rows) {
    SCOPED_TRACE(row.dump());
    EXPECT_GT(row.at("detect_ms"), 0.0);
    EXPECT_EQ(row.at("missed"), 0);
    EXPECT_EQ(row.at("false"), 0);
    EXPECT_EQ(row.at("wrong_bounds"), 0);
    if (row.at("deadline_ms") == 0.0) {
      EXPECT_EQ(row.at("found"), 1.0);
      EXPECT_LE(row.at("error"), row.at("bound"));
    }
    if (row.at("setting") == "exact" && row.at("query") != "contacts") {
      EXPECT_EQ(row.at("error"), 0.0);
    }
  }
  EXPECT_NE(
      bench("accuracy --scene tress_a --scale 0.01 --repeats 1").out.find("tolerance of 0.10"),
      std::string::npos);
}

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

TEST_F(FiberBench, RefusesBadCommandLines) {
  EXPECT_TRUE(refused(bench(""), "a subcommand is needed: update, cycle"));
  EXPECT_TRUE(refused(bench("race"), "race"));
  EXPECT_TRUE(refused(bench("cycle --scene spaghetti"), "'spaghetti', known are: "));
  EXPECT_TRUE(
      refused(bench("cycle --scale 0.001 --engines AL,XL"), "'XL', known are: run_tree, AL"));
  EXPECT_TRUE(refused(bench("cycle --engines"), "--engines"));
  EXPECT_TRUE(refused(bench("cycle --scale 0"), "scale is 0"));
  EXPECT_TRUE(refused(bench("update --repeats 0"), "--repeats: '0'"));
  EXPECT_TRUE(refused(bench("cycle --copies 0"), "--copies: '0'"));
  EXPECT_TRUE(refused(bench("cycle --scale 0.001 --copies 4000000"),
                      "copies is 4000000, of this scene at most 2"));
  EXPECT_TRUE(refused(bench("stages --until tea"), "tea"));
  EXPECT_TRUE(refused(bench("coherence --motion -1"), "--motion: '-1' must be a finite number"));
  EXPECT_TRUE(refused(bench("coherence --motion nan"), "--motion: 'nan' must be a finite number"));
  EXPECT_TRUE(
      refused(bench("coherence --skins 0,thin"), "--skins: 'thin' must be a finite number"));
  EXPECT_TRUE(refused(bench("coherence --skins"), "--skins"));
  EXPECT_TRUE(refused(bench("coherence --moving 2"), "--moving"));
  EXPECT_TRUE(refused(bench("coherence --frames 0"), "--frames: '0'"));
  EXPECT_TRUE(refused(bench("simulate --parts theory"), "--parts"));
  EXPECT_TRUE(refused(bench("simulate --segments 10,0"), "--segments: '0'"));
  EXPECT_TRUE(refused(bench("simulate --reference-segments 1"), "--reference-segments: '1'"));
  EXPECT_TRUE(refused(bench("update --threads none"), "--threads: 'none'"));
  EXPECT_TRUE(refused(bench("kernels --kernels robust,quick"),
                      "unknown kernel 'quick', known are: robust, robust_batch, "));
  EXPECT_TRUE(refused(bench("kernels --families easy"),
                      "unknown family 'easy', known are: generic, scale_1e-300, "));
  EXPECT_TRUE(refused(bench("kernels --pairs 0"), "--pairs: '0'"));
  EXPECT_TRUE(refused(bench("kernels --repeats 0"), "--repeats: '0'"));
  EXPECT_TRUE(refused(bench("kernels --kernels"), "--kernels"));
  EXPECT_TRUE(refused(bench("motions --parts times,truth"), "truth"));
  EXPECT_TRUE(refused(bench("motions --parts times --kernels own,quick"),
                      "unknown kernel 'quick', known are: own, own_single, "));
  EXPECT_TRUE(refused(bench("motions --parts accuracy --families easy"),
                      "unknown family 'easy', known are: random, translating, "));
  EXPECT_TRUE(refused(bench("motions --count 0"), "--count: '0'"));
  EXPECT_TRUE(refused(bench("motions --parts scenes --scenes stew"), "unknown scene 'stew'"));
  EXPECT_TRUE(refused(bench("motions --ways 1,-1"), "--ways: '-1' must be a finite"));
  EXPECT_TRUE(
      refused(bench("motions --tolerances 1e-6,-1"), "--tolerances: '-1' must be a finite"));
  EXPECT_TRUE(refused(bench("environment --parts cell,kitchen"), "kitchen"));
  EXPECT_TRUE(refused(bench("environment --points 1"), "--points: '1'"));
  EXPECT_TRUE(refused(bench("environment --margin inf"), "--margin: 'inf' must be a finite"));
  EXPECT_TRUE(refused(bench("environment --repeats 0"), "--repeats: '0'"));
}

#ifdef FIBER_BENCH_HAS_LATENCY
TEST_F(FiberBench, LatencyNeedsAMaster) {
  for (const char* const command : {" latency", " obstacle_latency"}) {
    EXPECT_TRUE(refused(
        run_process(std::string("ROS_MASTER_URI=http://127.0.0.1:1 " FIBER_BENCH) + command),
        "no ROS master at http://127.0.0.1:1"));
  }
}
#endif

}  // namespace
}  // namespace fiber::test

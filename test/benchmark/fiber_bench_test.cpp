// fiber_bench: what engines cost, and command lines.
#include "test/benchmark/fiber_bench.hpp"

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fiber::test {
namespace {

TEST_F(FiberBench, EnginesAgreeOnEverySubcommand) {
  // With this seed, two fibres touch in frame 2.
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

TEST_F(FiberBench, ADeviceHasTheContactsOfRunTree) {
  const ProcessResult result =
      bench("device --device host --scene tress_a --scale 0.04 --repeats 2 --json");
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.err, "");
  const nlohmann::json row = json_lines(result.out).at(0);
  EXPECT_EQ(row.at("segments"), 9800);
  EXPECT_GT(row.at("contacts"), 100);
  for (const char* const time :
       {"update_ms", "to_host_ms", "all_ms", "locked_ms", "copied_ms", "run_tree_ms"}) {
    EXPECT_GT(row.at(time), 0.0) << time;
  }
  EXPECT_EQ(bench("device --device tpu").exit_code, 2);
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
  ASSERT_EQ(rows.size(), 4U);
  const std::vector<double> skins{0.0, 0.1, 0.6};
  // By themselves two points may have come nearer by twice the motion: 0.1 would not last one
  // frame, 0.6 three. What is near each other moves alike, so that they last for more.
  const std::vector<int> most_refits{12, 11, 2};
  EXPECT_EQ(rows[0].at("refits"), 12);
  EXPECT_EQ(rows[3].at("skin_lengths"), "automatic");
  EXPECT_EQ(rows[3].at("pairs"), rows[0].at("pairs"));
  for (std::size_t i = 0; i < skins.size(); ++i) {
    EXPECT_EQ(rows[i].at("scene"), "curly");
    EXPECT_EQ(rows[i].at("engine"), "run_tree");
    EXPECT_EQ(rows[i].at("segments"), 4700);
    EXPECT_EQ(rows[i].at("threads"), 1);
    EXPECT_EQ(rows[i].at("motion"), 0.1);
    EXPECT_EQ(rows[i].at("skin_lengths"), skins[i]);
    EXPECT_EQ(rows[i].at("skin"), skins[i] * rows[i].at("segment_length").get<double>());
    EXPECT_GT(rows[i].at("segment_length"), 0.0);
    EXPECT_LE(rows[i].at("refits"), most_refits[i]) << i;
    EXPECT_GE(rows[i].at("refits"), 1) << i;
    EXPECT_GT(rows[i].at("detect_ms"), 0.0);
    EXPECT_EQ(rows[i].at("cycle_ms"),
              rows[i].at("update_ms").get<double>() + rows[i].at("detect_ms").get<double>());
    EXPECT_GT(rows[i].at("pairs"), 0);
    EXPECT_EQ(rows[i].at("pairs"), rows[0].at("pairs"));
  }
}

TEST_F(FiberBench, ShowsOtherEnginesBesideTheSkins) {
  const ProcessResult result = bench(
      "coherence --scene curly --scale 0.001 --frames 3 --skins 0 --engines AL,brute_force --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::vector<nlohmann::json> rows = json_lines(result.out);
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[2].at("engine"), "AL");
  EXPECT_EQ(rows[3].at("engine"), "brute_force");
  for (std::size_t i = 2; i < rows.size(); ++i) {
    EXPECT_TRUE(rows[i].at("skin_lengths").is_null());
    EXPECT_TRUE(rows[i].at("refits").is_null());
    EXPECT_GT(rows[i].at("detect_ms"), 0.0);
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
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].at("partial"), 0);
  EXPECT_EQ(rows[1].at("partial"), 6);
  EXPECT_EQ(rows[1].at("moving"), 0.1);
  EXPECT_EQ(rows[1].at("pairs"), rows[0].at("pairs"));
}

/// Two cables that come nearer to each other, one of them at a time, and touch in the last frames.
std::string file_of_frames(const std::string& name, int frames, int points_of_last = 3) {
  const std::string path = testing::TempDir() + name;
  std::ofstream file(path);
  file << "frame,fiber,x,y,z,radius\n";
  for (int frame = 0; frame < frames; ++frame) {
    const int points = frame + 1 == frames ? points_of_last : 3;
    for (int fiber = 0; fiber < 2; ++fiber) {
      for (int point = 0; point < points; ++point) {
        file << frame << ',' << fiber << ',' << point << ',' << fiber * (0.5 - 0.05 * frame)
             << ",0,0.15\n";
      }
    }
  }
  return path;
}

TEST_F(FiberBench, MeasuresAUsersOwnFrames) {
  const std::string file = file_of_frames("frames.csv", 6);
  const std::vector<nlohmann::json> engines = json_lines(
      bench("cycle --scene " + file + " --engines run_tree,brute_force --repeats 5 --json").out);
  ASSERT_EQ(engines.size(), 2U);
  for (const nlohmann::json& row : engines) {
    EXPECT_EQ(row.at("segments"), 4);
    EXPECT_GE(row.at("pairs"), 2) << "frame 5 has contacts";
  }
  // There, 5 frames, and back: no contacts again in frame 10.
  const ProcessResult back =
      bench("update --scene " + file + " --engines run_tree --repeats 10 --json");
  EXPECT_EQ(json_lines(back.out).at(0).at("pairs"), 0) << back.err;
  const std::vector<nlohmann::json> skins =
      json_lines(bench("coherence --scene " + file + " --frames 8 --skins 0 --json").out);
  ASSERT_EQ(skins.size(), 2U);
  // One of the two moves by 0.05 of a segment.
  EXPECT_NEAR(skins[0].at("motion"), 0.025, 1e-12);
}

TEST_F(FiberBench, HasTheOneFrameOfAFileSway) {
  const std::string file = file_of_frames("one_frame.csv", 1);
  const std::vector<nlohmann::json> skins = json_lines(
      bench("coherence --scene " + file + " --frames 8 --motion 0.03 --skins 0 --json").out);
  ASSERT_EQ(skins.size(), 2U);
  // Points sway further than segments are long, and stretch them: these are longer in frame 0.
  EXPECT_NEAR(skins[0].at("motion"), 0.03, 0.01);
}

TEST_F(FiberBench, RefusesFilesThatCannotBeMeasured) {
  EXPECT_TRUE(refused(bench("cycle --scene nowhere.csv"), "nowhere.csv"));
  EXPECT_TRUE(refused(bench("cycle --scene " + file_of_frames("other.csv", 3, 2)),
                      "frame 2 has other fibres, numbers of points or radii than the first"));
  EXPECT_TRUE(refused(bench("cycle --scale 2 --scene " + file_of_frames("scaled.csv", 2)),
                      "scale is of the package's scenes"));
  EXPECT_TRUE(refused(bench("cycle --scene stew"), "unknown scene 'stew'"));
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
  const std::string table = bench("accuracy --scene tress_a --scale 0.01 --repeats 1").out;
  for (const char* const text : {"late [% of the deadline]", "found [%]", "tolerance of 0.10"}) {
    EXPECT_NE(table.find(text), std::string::npos) << table;
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
  EXPECT_TRUE(refused(bench("coherence --scale 0.001 --engines swift"), "'swift'"));
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

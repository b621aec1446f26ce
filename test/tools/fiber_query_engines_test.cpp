// fiber_query --engine
#include <string>
#include <vector>

#include "fiber_proximity/cuda/cuda_engines.hpp"
#include "test/support/engine_names.hpp"
#include "test/support/shared_data.hpp"
#include "test/tools/fiber_query.hpp"

namespace fiber::test {
namespace {

TEST_F(FiberQuery, NearestAnswersEveryFrameWithEveryEngine) {
  const std::string path = soup("--scale 0.005 --frames 3 --seed 4");
  const std::string arguments = "nearest " + path + " --point 0.1,-0.05,0.2 --k 7 --engine ";
  const ProcessResult expected = query(arguments + "brute_force");
  EXPECT_EQ(lines(expected.out).size(), 1U + 3 * 7);
  EXPECT_EQ(lines(expected.out)[0] + "\n", "frame," + columns);
  for (const std::string& engine : all_engine_names()) {
    EXPECT_EQ(query(arguments + engine).out, expected.out) << engine;
  }
}

TEST_F(FiberQuery, AgreesWithBruteForceInEveryFrame) {
  const std::string path = soup("--scale 0.002 --frames 3 --seed 4");
  for (const std::string command : {"contacts", "closest", "fiber_pairs"}) {
    const std::string arguments = " " + path + " --margin 0.005 --threads 2";
    const ProcessResult tree = query(command + arguments + " --engine AL");
    EXPECT_EQ(tree.exit_code, 0) << tree.err;
    EXPECT_GT(lines(tree.out).size(), 3U) << "frames with contacts make the comparison worth it";
    EXPECT_EQ(tree.out, query(command + arguments + " --engine brute_force").out);
  }
}

TEST_F(FiberQuery, EveryEnginePrintsTheSameBytes) {
  std::vector<std::string> engines = all_engine_names();
  engines.insert(engines.end(), {"DL-6", "DS-200", "DL-26-classic"});
  const std::string tress = "tress_a --scale 0.004 --seed 3";
  ASSERT_EQ(scene(tress + " --frames 2 --out " + path("moving.csv")).exit_code, 0);
  ASSERT_EQ(scene(tress + " --shuffle --out " + path("still.hair")).exit_code, 0);
  for (const std::string file : {"moving.csv", "still.hair"}) {
    for (const std::string command : {"contacts ", "closest ", "fiber_pairs "}) {
      const std::string arguments = command + path(file) + " --margin 0.0002 --engine ";
      const ProcessResult expected = query(arguments + "brute_force");
      EXPECT_GE(lines(expected.out).size(), command == "closest " ? 2U : 10U);
      for (const std::string& engine : engines) {
        const ProcessResult result = query(arguments + engine);
        EXPECT_EQ(result.exit_code, 0) << engine << ": " << result.err;
        EXPECT_EQ(result.out, expected.out) << command << file << " with " << engine;
      }
    }
  }
}

TEST_F(FiberQuery, AnEngineThatIsNoneIsRefusedWithAllThereAre) {
  const std::string file = crossing();
  register_paper_engines();
  register_cuda_engines();
  std::string known;
  for (const std::string& name : engine_names()) {
    known += (known.empty() ? "known are: " : ", ") + name;
  }
  known += "; DL-k and DS-k for even k from 6 to 200";
  for (const std::string engine : {"DL-7", "DL-4", "DL-202", "XX", "DS-", "DL-20x", "\"\""}) {
    EXPECT_TRUE(refused(query("contacts " + file + " --engine " + engine), known));
  }
  EXPECT_TRUE(
      refused(query("contacts " + file + " --engine DL-7"),
              "'DL-7' (k-DOP with k = 7: k must be even, from 6 to 200), known are: run_tree, AL"));
}

TEST_F(FiberQuery, ThreadingRefusesFibresOfDifferentLength) {
  EXPECT_TRUE(refused(query("contacts " + crossing() + " --engine AL-threaded"),
                      "fibre 1 has 1 segment(s), fibre 0 has 2; threading needs the same number"));
}

TEST_F(FiberQuery, AnswersTheRecordedCables) {
  const std::filesystem::path data = shared_data();
  if (!std::filesystem::exists(data / "cable_track_a.csv")) {
    GTEST_SKIP() << "no recorded cables in " << data;
  }
  for (const std::string name : {"a", "b", "c"}) {
    const std::string arguments =
        "contacts " + (data / ("cable_track_" + name + ".csv")).string() + " --margin 0.08";
    const ProcessResult tree = query(arguments);
    EXPECT_EQ(tree.exit_code, 0) << tree.err;
    EXPECT_EQ(tree.out, query(arguments + " --engine brute_force").out);
  }
}

}  // namespace
}  // namespace fiber::test

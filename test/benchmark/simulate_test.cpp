#include <algorithm>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "test/benchmark/fiber_bench.hpp"

namespace fiber::test {
namespace {

TEST_F(FiberBench, HoldsTheSimulationAgainstTheory) {
  // instability takes half a minute, and sim_validation_test asks the same.
  const ProcessResult result = bench(
      "simulate --parts validation --validations "
      "cantilevers,catenaries,loads,joints,motion,friction,impacts --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::vector<nlohmann::json> rows = json_lines(result.out);
  ASSERT_GT(rows.size(), 40U);
  for (const nlohmann::json& row : rows) {
    EXPECT_LE(std::abs(row.at("error").get<double>()), row.at("allowed").get<double>())
        << row.dump();
  }
}

TEST_F(FiberBench, SaysWhatTheSimulationCostsAndHowItErrs) {
  const ProcessResult result = bench(
      "simulate --parts convergence,xpbd,effects --segments 10,20 --substeps 1,8 "
      "--residuals 1e-1,1e-6 --max-iterations 1 --xpbd-segments 10 --xpbd-substeps 10,400 "
      "--xpbd-inertias 1 --frames 20 "
      "--reference-segments 20 --reference-substeps 16 --least-ms 0 --cables 2 --cable-segments 8 "
      "--cable-frames 2 --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "") << "progress is for terminals";
  std::map<std::string, std::vector<nlohmann::json>> parts;
  for (const nlohmann::json& row : json_lines(result.out)) {
    parts[row.at("part")].push_back(row);
  }
  const std::vector<nlohmann::json>& hose = parts["convergence"];
  ASSERT_EQ(hose.size(), 2U * 2U * 2U + 2U + 2U + 2U * (2U + 1U));
  EXPECT_EQ(hose[0].at("method"), "implicit_euler");
  EXPECT_GT(hose[2].at("error"), 2.0 * hose[3].at("error").get<double>()) << "by substeps";
  EXPECT_EQ(hose[8].at("motion"), "settling");
  for (const nlohmann::json& row : hose) {
    if (row.at("varied") == "residual") {
      EXPECT_LE(row.at("worst_residual"), row.at("residual").get<double>()) << row.dump();
    }
    if (row.at("varied") == "max_iterations") {
      EXPECT_EQ(row.at("iterations"), 1.0) << row.dump();
    }
  }
  const std::vector<nlohmann::json>& xpbd = parts["xpbd"];
  ASSERT_EQ(xpbd.size(), 2U * 2U);
  EXPECT_GT(xpbd[0].at("error"), 2.0 * xpbd[1].at("error").get<double>())
      << "it converges to the same";
  for (const nlohmann::json& row : parts["effects"]) {
    const std::string added = row.at("added");
    const bool has_twist = added == "twist" || added == "rolling" || added == "all";
    EXPECT_EQ(row.at("unknowns_per_node"), has_twist ? 4 : 3) << row.dump();
    EXPECT_EQ(row.at("nodes"), added == "ball" || added == "weld" ? 20 : 18) << "halves";
    EXPECT_GT(row.at("bytes"), 0);
  }
  EXPECT_EQ(parts["effects"].size(), 19U);
}

TEST_F(FiberBench, SaysWhatAccuracyCostsInContact) {
  const ProcessResult result =
      bench("simulate --parts contacts --contact-edges 16,48 --contact-substeps 4,64 --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::vector<nlohmann::json> rows = json_lines(result.out);
  ASSERT_EQ(rows.size(), 2U + 2U * 2U);
  for (std::size_t i = 0; i < rows.size(); i += 2) {
    const auto error = [&](std::size_t row) {
      return std::abs(rows[row].at("error").get<double>());
    };
    EXPECT_LT(error(i + 1), error(i)) << rows[i + 1].dump();
    EXPECT_LT(error(i + 1), 0.05);
    EXPECT_GT(rows[i + 1].at("ms"), rows[i].at("ms").get<double>());
  }
}

TEST_F(FiberBench, SaysHowFastLargeScenesAreBesideTheClock) {
  const ProcessResult result = bench(
      "simulate --parts real_time --load-cables 2 --load-rods 5 --load-branches 2 --load-frames 4 "
      "--load-substeps 2 --load-threads 1,0 --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const std::vector<nlohmann::json> rows = json_lines(result.out);
  ASSERT_EQ(rows.size(), 4U * 2U);
  EXPECT_EQ(rows[0].at("scene"), "cables in contact");
  EXPECT_EQ(rows[1].at("rods"), 5);
  EXPECT_EQ(rows[1].at("threads"), 1);
  EXPECT_EQ(rows[2].at("scene"), "prediction of a cable");
  EXPECT_EQ(rows[3].at("scene"), "harness on an arm");
  EXPECT_EQ(rows[3].at("rods"), 3);
  for (const nlohmann::json& row : rows) {
    EXPECT_GE(row.at("threads"), 1);
    const double steps_per_second = 60.0 * row.at("substeps").get<double>();
    EXPECT_NEAR(row.at("real_time_factor").get<double>() * row.at("ms_per_step").get<double>(),
                1e3 / steps_per_second, 1e-6)
        << row.dump();
  }
}

using Rows = std::vector<nlohmann::json>;

/// The smallest value of a field in rows of a scene that are done; none may stand still.
double min_of_moving(const Rows& rows, const std::string& scene, const std::string& method,
                     const std::string& field, int segments) {
  double least = std::numeric_limits<double>::infinity();
  for (const nlohmann::json& row : rows) {
    if (row.at("scene") == scene && row.at("method") == method && row.at("ending") == "done" &&
        row.at("segments") == segments) {
      EXPECT_GT(row.at("moved"), 0.05) << row.dump();  // [m], of 1 m of cable
      least = std::min(least, row.at(field).get<double>());
    }
  }
  EXPECT_LT(least, std::numeric_limits<double>::infinity())
      << scene << ": no run of " << method << " with " << segments << " segments is done";
  return least;
}

TEST_F(FiberBench, HoldsTheSimulationBesideOtherSimulators) {
  const ProcessResult result = bench(
      "simulate --parts peers --peer-segments 8,20 --peer-cables 2 --peer-cable-segments 10 "
      "--peer-repeats 1 --reference-segments 80 --reference-substeps 32 --json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const Rows rows = json_lines(result.out);
  std::vector<std::string> peers;
  for (const auto& [name, method] :
       {std::pair("Bullet", "bullet"), std::pair("MuJoCo", "mujoco")}) {
    const std::string missing = std::string("this build is without ") + name;
    if (result.err.find(missing) == std::string::npos) {
      peers.emplace_back(method);
    }
  }
  EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 2 - peers.size()) << result.err;
  for (const nlohmann::json& row : rows) {
    EXPECT_TRUE(row.at("method") == "own" ||
                std::count(peers.begin(), peers.end(), row.at("method").get<std::string>()) == 1)
        << row.dump();
    if (row.at("method") == "own") {
      EXPECT_EQ(row.at("ending"), "done") << row.dump();
      EXPECT_EQ(row.at("passed"), 0) << row.dump();
    }
  }
  // A chain of rigid links is about as right as a rod of as many nodes, in several times the time.
  for (const char* const scene : {"hanging", "cantilever"}) {
    const double own = min_of_moving(rows, scene, "own", "error", 20);
    EXPECT_LT(own, 0.01) << scene;
    for (const std::string& peer : peers) {
      EXPECT_LT(own, min_of_moving(rows, scene, peer, "error", 8)) << scene << ", " << peer;
      min_of_moving(rows, scene, peer, "error", 20);
    }
  }
  const double own_depth = min_of_moving(rows, "falling", "own", "deepest", 10);
  EXPECT_LT(own_depth, 0.2) << "in radii: axes are never nearer than 0.9 of the sum of radii";
  for (const std::string& peer : peers) {
    EXPECT_LT(own_depth, min_of_moving(rows, "falling", peer, "deepest", 10)) << peer;
  }
}

}  // namespace
}  // namespace fiber::test

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "benchmark/peers/peer.hpp"
#include "fiber_proximity/paper/paper_engines.hpp"
#include "src/hierarchy/segment_boxes.hpp"
#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"
#include "test/support/error_of.hpp"
#include "test/support/process.hpp"

namespace fiber::test {
namespace {

/// Every peer must give exactly brute force's contacts, or a comparison of times means nothing.
class PeerTest : public testing::TestWithParam<std::string> {
 protected:
  static QueryResult ask(ProximityEngine& peer, const FiberAssembly& fibers,
                         const QueryOptions& options) {
    peer.update(fibers);
    return answer(peer, options);
  }
};

/// Copies the fibres with points moved a little.
void move(FiberAssembly& fibers, double step, Random& random) {
  std::vector<Eigen::Vector3d> points = fibers.points();
  for (Eigen::Vector3d& point : points) {
    point += step * random.in_cube();
  }
  fibers.update_points(points);
}

TEST_P(PeerTest, GivesBruteForcesContactsBeforeAndAfterAMove) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const AssemblyFamily& family : assembly_families()) {
    for (int round = 0; round < 6; ++round) {
      SCOPED_TRACE(family.name + ", round " + std::to_string(round));
      const BenchEngineOptions bench{static_cast<std::uint32_t>(random.integer(1, 2)),
                                     random.chance(0.5) ? 0.0 : random.uniform(0.0, 0.3)};
      const std::unique_ptr<ProximityEngine> peer = make_bench_engine(GetParam(), bench);
      QueryOptions options;
      options.margin = bench.margin;
      options.neighbour_skip = static_cast<std::uint32_t>(random.integer(0, 2));
      FiberAssembly fibers = family.make(random);
      for (int frame = 0; frame < 3; ++frame) {
        const QueryResult found = ask(*peer, fibers, options);
        ASSERT_TRUE(same_contacts(found.contacts, brute_force(fibers, options).contacts))
            << "frame " << frame << ", margin " << options.margin << ", threads " << bench.threads;
        move(fibers, 0.05, random);
      }
    }
  }
}

TEST_P(PeerTest, FollowsAChangeOfTopology) {
  SCOPED_TRACE(seed_message());
  Random random;
  const std::unique_ptr<ProximityEngine> peer = make_bench_engine(GetParam());
  for (int round = 0; round < 20; ++round) {
    const FiberAssembly fibers = assembly_families().front().make(random);
    ASSERT_TRUE(same_contacts(ask(*peer, fibers, QueryOptions{}).contacts,
                              brute_force(fibers, QueryOptions{}).contacts));
  }
}

/// Many fibres, so that trees have levels and threads have work.
FiberAssembly many_walks(Random& random) { return walks(random, 60, 30, 0.02, 0.005); }

TEST_P(PeerTest, OffersThePairsWhoseBoxesOverlapAndNoOthers) {
  SCOPED_TRACE(seed_message());
  Random random;
  FiberAssembly fibers = many_walks(random);
  const std::unique_ptr<ProximityEngine> peer = make_bench_engine(GetParam(), {2, 0.0});
  for (int frame = 0; frame < 3; ++frame) {
    SegmentBoxes boxes(0.0);
    boxes.update(fibers, false);
    QueryOptions options;
    options.neighbour_skip = 0;
    std::uint64_t overlapping = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (std::size_t j = i + 1; j < boxes.size(); ++j) {
        overlapping += overlaps(boxes[i], boxes[j], 0.0F) ? 1 : 0;
      }
    }
    const std::uint64_t offered = ask(*peer, fibers, options).counts.primitive_tests;
    if (GetParam() == "fcl_naive") {  // its boxes are larger
      EXPECT_GT(offered, overlapping);
      EXPECT_LT(offered, boxes.size() * boxes.size() / 8);
    } else {
      EXPECT_EQ(offered, overlapping);
    }
    move(fibers, 0.005, random);
  }
}

TEST_P(PeerTest, RefusesWhatItDoesNotAnswer) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = many_walks(random);
  const std::unique_ptr<ProximityEngine> peer = make_bench_engine(GetParam(), {1, 0.01});
  peer->update(fibers);
  QueryResult result;
  for (const QueryType type :
       {QueryType::FIRST, QueryType::CLOSEST, QueryType::LIMITED, QueryType::FIBER_PAIRS}) {
    QueryOptions options;
    options.type = type;
    EXPECT_THROW(peer->query(options, result), std::invalid_argument);
  }
  QueryOptions options;
  options.margin = 0.01;
  EXPECT_NO_THROW(peer->query(options, result));
  options.margin = 0.02;
  EXPECT_THROW(peer->query(options, result), std::invalid_argument);
  EXPECT_THROW(peer->query_shape(fibers, QueryOptions{}, result), std::invalid_argument);
}

TEST_P(PeerTest, TellsHowManyThreadsItUses) {
  const bool several = GetParam() == "cgal" || GetParam().rfind("embree", 0) == 0;
  EXPECT_EQ(make_bench_engine(GetParam(), {1, 0.0})->facts().thread_count, 1U);
  EXPECT_EQ(make_bench_engine(GetParam(), {2, 0.0})->facts().thread_count,
            several ? std::min(2U, std::thread::hardware_concurrency()) : 1U);
}

#ifdef GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(PeerTest);  // a build may be without peers
#endif
INSTANTIATE_TEST_SUITE_P(Peers, PeerTest, testing::ValuesIn(peer_names()),
                         [](const auto& instance) { return instance.param; });

std::string refusal(const std::string& name) {
  register_paper_engines();
  return error_of([&] { make_bench_engine(name); });
}

TEST(MakeBenchEngine, MakesPeersAndEngines) {
  EXPECT_EQ(refusal("AL"), "no error");
  EXPECT_EQ(refusal("DL-14-classic"), "no error");
  EXPECT_EQ(refusal("octree").find("unknown engine 'octree', known are: run_tree, AL"), 0U);
  EXPECT_NE(refusal("octree").find("; peers are: bullet, cgal, embree_low, embree_medium, "
                                   "embree_refit, fcl, fcl_naive"),
            std::string::npos);
}

TEST(MakeBenchEngine, SaysWhichPackageAMissingPeerNeeds) {
  const std::vector<std::string> present = peer_names();
  for (const std::string& name : all_peer_names()) {
    const bool is_present = std::count(present.begin(), present.end(), name) == 1;
    EXPECT_EQ(refusal(name).find("-dev") != std::string::npos, !is_present) << name;
  }
}

TEST(FiberBench, RunsThePeersBesideOurEngines) {
  std::string engines = "run_tree,AL";
  for (const std::string& name : peer_names()) {
    engines += "," + name;
  }
  const ProcessResult result = run_process(
      FIBER_BENCH " cycle --scene tress_b --scale 0.02 --repeats 2 --threads 2 --json --engines " +
      engines);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  std::istringstream lines(result.out);
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const nlohmann::json row = nlohmann::json::parse(line);
    const std::string name = row.at("engine");
    EXPECT_GT(row.at("pairs"), 0) << name;
    EXPECT_EQ(row.at("threads"), make_bench_engine(name, {2, 0.0})->facts().thread_count) << name;
  }
  EXPECT_EQ(count, 2 + peer_names().size());
}

}  // namespace
}  // namespace fiber::test

#include "fiber_proximity/query/engine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "fiber_proximity/paper/paper_engines.hpp"
#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"
#include "test/support/engines_test.hpp"
#include "test/support/error_of.hpp"
#include "test/support/neighbour_skips.hpp"
#include "test/support/query_options.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"
#include "validation/geometry/hard_pairs.hpp"

namespace fiber::test {
namespace {

/// Every engine must answer exactly what brute force answers.
class EngineTest : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override { engine_ = make_engine(GetParam()); }

  /// A member of the family this engine can take: threading wants equal fibres.
  FiberAssembly make(const AssemblyFamily& family, Random& random) const {
    FiberAssembly fibers = family.make(random);
    return GetParam() == "AL-threaded" ? equal_fibers(fibers) : fibers;
  }

  QueryResult ask(const FiberAssembly& fibers, const QueryOptions& options) {
    engine_->update(fibers);
    return answer(*engine_, options);
  }

  std::unique_ptr<ProximityEngine> engine_;
};

TEST_P(EngineTest, GivesBruteForcesAnswerOnEveryFamily) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const AssemblyFamily& family : assembly_families()) {
    for (int round = 0; round < rounds(4); ++round) {
      const FiberAssembly fibers = make(family, random);
      for (const QueryType type : {QueryType::ALL, QueryType::CLOSEST, QueryType::LIMITED}) {
        const QueryOptions options = random_options(random, extent_of(fibers), type);
        SCOPED_TRACE(family.name + ", round " + std::to_string(round) + ", type " +
                     std::to_string(static_cast<int>(type)) + ", margin " +
                     std::to_string(options.margin) + ", " + skips_of(options));
        const QueryResult found = ask(fibers, options);
        const QueryResult expected = brute_force(fibers, options);
        ASSERT_TRUE(same_contacts(found.contacts, expected.contacts));
        ASSERT_EQ(found.limit_reached, expected.limit_reached);
      }
    }
  }
}

/// Volumes are in single precision: products of a few lengths leave its range long before lengths
/// do.
TEST_P(EngineTest, FindsCapsulesThatTouchAtEveryMagnitude) {
  SCOPED_TRACE(seed_message());
  const std::vector<HardPair> pairs = hard_pairs(hard_families().front(), 20, run_seed());
  for (int exponent = -200; exponent <= 200; exponent += 2) {
    const double scale = std::ldexp(1.0, exponent);
    for (const HardPair& pair : pairs) {
      const FiberAssembly fibers(
          {scale * pair.p0, scale * pair.p1, scale * pair.q0, scale * pair.q1}, {0, 2, 4},
          {scale * pair.radius_a, scale * pair.radius_b});
      ASSERT_TRUE(same_contacts(ask(fibers, {}).contacts, brute_force(fibers, {}).contacts))
          << "scale 2^" << exponent;
    }
  }
}

TEST_P(EngineTest, FindsAFirstContactIfAndOnlyIfThereIsOne) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const AssemblyFamily& family : assembly_families()) {
    for (int round = 0; round < rounds(4); ++round) {
      SCOPED_TRACE(family.name);
      const FiberAssembly fibers = make(family, random);
      QueryOptions options = random_options(random, extent_of(fibers), QueryType::FIRST);
      const QueryResult first = ask(fibers, options);
      options.type = QueryType::ALL;
      options.contact_limit = 0;
      const QueryResult all = brute_force(fibers, options);
      ASSERT_EQ(first.contacts.size(), all.contacts.empty() ? 0U : 1U);
      if (!all.contacts.empty()) {
        ASSERT_TRUE(contains(all.contacts, first.contacts.front()));
      }
    }
  }
}

TEST_P(EngineTest, AnswersShapesAsBruteForceDoes) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const AssemblyFamily& family : assembly_families()) {
    for (int round = 0; round < rounds(4); ++round) {
      const FiberAssembly fibers = make(family, random);
      const FiberAssembly shape = make(family, random);
      for (const QueryType type : {QueryType::ALL, QueryType::CLOSEST, QueryType::LIMITED}) {
        SCOPED_TRACE(family.name);
        const QueryOptions options = random_options(random, extent_of(fibers), type);
        engine_->update(fibers);
        const QueryResult found = answer(*engine_, shape, options);
        const QueryResult expected = brute_force(shape, fibers, options);
        ASSERT_TRUE(same_contacts(found.contacts, expected.contacts));
      }
    }
  }
}

TEST_P(EngineTest, AsksTheFibersAboutThemselvesAsAnyOtherShape) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = walks(random, 1, 10, 0.1, 0.01);
  engine_->update(fibers);
  const QueryResult result = answer(*engine_, fibers, {});
  // Every segment touches itself and its two neighbours, in both orders.
  EXPECT_GE(result.contacts.size(), 10U + 2U * 9U);
}

TEST_P(EngineTest, FollowsMovingFibersAndChangingTopology) {
  SCOPED_TRACE(seed_message());
  Random random;
  const std::vector<AssemblyFamily> families = assembly_families();
  for (int round = 0; round < rounds(30); ++round) {
    FiberAssembly fibers = make(families[random.integer(0, 2)], random);
    for (int frame = 0; frame < 4; ++frame) {
      const QueryResult found = ask(fibers, QueryOptions{});
      ASSERT_TRUE(same_contacts(found.contacts, brute_force(fibers, QueryOptions{}).contacts));
      fibers.update_points(shaken(fibers, 0.05, random).points());
    }
  }
}

TEST_P(EngineTest, RepeatsItselfToTheBit) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = make(assembly_families().front(), random);
  for (const QueryType type : {QueryType::FIRST, QueryType::CLOSEST, QueryType::LIMITED,
                               QueryType::ALL, QueryType::FIBER_PAIRS}) {
    const QueryOptions options = within(0.3, type);
    const QueryResult once = ask(fibers, options);
    engine_ = make_engine(GetParam());
    const QueryResult again = ask(fibers, options);
    EXPECT_TRUE(same_contacts(once.contacts, again.contacts));
    EXPECT_EQ(once.counts.node_tests, again.counts.node_tests);
    EXPECT_EQ(once.counts.primitive_tests, again.counts.primitive_tests);
  }
}

TEST_P(EngineTest, RefusesBadOptionsAndQueriesBeforeAnUpdate) {
  QueryResult result;
  EXPECT_THROW(engine_->query(QueryOptions{}, result), std::logic_error);
  const FiberAssembly none;
  engine_->update(none);
  engine_->query(QueryOptions{}, result);
  EXPECT_TRUE(result.contacts.empty());
  const QueryOptions bad = within(-1.0);
  EXPECT_THROW(engine_->query(bad, result), std::invalid_argument);
  EXPECT_THROW(engine_->query_shape(none, bad, result), std::invalid_argument);
}

TEST_P(EngineTest, DrawsBoxesAroundAllItsSegments) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = walks(random, 1, 50, 0.1, 0.01);
  engine_->update(fibers);
  for (std::uint32_t level = 0; level < engine_->facts().level_count + 2; ++level) {
    std::vector<NodeBox> boxes;
    engine_->level_boxes(level, boxes);
    if (engine_->facts().level_count == 0) {
      EXPECT_TRUE(boxes.empty());
      continue;
    }
    // Eight children per node, or two.
    EXPECT_LE(boxes.size(), std::size_t{1} << (GetParam() == "run_tree" ? 3 * level : level));
    for (const Eigen::Vector3d& point : fibers.points()) {
      const bool inside = std::any_of(boxes.begin(), boxes.end(), [&](const NodeBox& box) {
        return (point.array() >= box.lower.array() + 0.009).all() &&
               (point.array() <= box.upper.array() - 0.009).all();
      });
      EXPECT_TRUE(inside) << "level " << level;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, EngineTest, all_engines(), name_of_engine);

std::string refusal(const std::string& name) {
  register_paper_engines();
  return error_of([&] { make_engine(name); });
}

const std::string known_engines =
    ", known are: run_tree, AL, AL-threaded, AS, DL-20, DS-20, SL, SW, SS, OL, OW, OS, cuda_tree, "
    "brute_force; DL-k and "
    "DS-k for even k from 6 to 200; DL-k-classic and DS-k-classic for k of 6, 14, 18, 26";

TEST(MakeEngine, ListsTheNamesItKnows) {
  for (const std::string name : {"octree", "", "al", "AL ", "DL", "DL-", "DS-", "DL-x", "DL-20x",
                                 "DL-20-classical", "DL--classic", "SL-20", "DL-99999999999"}) {
    EXPECT_EQ(refusal(name), "unknown engine '" + name + "'" + known_engines);
  }
}

TEST(MakeEngine, TellsWhatIsWrongWithK) {
  for (const std::string kind : {"DL-", "DS-"}) {
    for (const std::string k : {"7", "5", "4", "0", "-6", "201", "202"}) {
      EXPECT_EQ(refusal(kind + k), "unknown engine '" + kind + k + "' (k-DOP with k = " + k +
                                       ": k must be even, from 6 to 200)" + known_engines);
    }
    for (const std::string k : {"8", "15", "20"}) {
      EXPECT_EQ(refusal(kind + k + "-classic"), "unknown engine '" + kind + k +
                                                    "-classic' (classic k-DOP with k = " + k +
                                                    ": k must be 6, 14, 18 or 26)" + known_engines);
    }
  }
}

TEST(MakeEngine, TakesEveryKThatItPromises) {
  for (const std::string kind : {"DL-", "DS-"}) {
    for (int k = 6; k <= 200; k += 2) {
      EXPECT_EQ(refusal(kind + std::to_string(k)), "no error");
    }
    for (const int k : {6, 14, 18, 26}) {
      EXPECT_EQ(refusal(kind + std::to_string(k) + "-classic"), "no error");
    }
  }
}

}  // namespace
}  // namespace fiber::test

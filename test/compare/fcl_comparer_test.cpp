#include "fiber_proximity/compare/fcl_comparer.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "fiber_proximity/scenes/scene.hpp"
#include "test/support/answers.hpp"
#include "test/support/hard_scenes.hpp"
#include "test/support/joined_fibers.hpp"
#include "test/support/neighbour_skips.hpp"
#include "test/support/small_scene.hpp"

namespace fiber::test {
namespace {

class FclComparerTest : public testing::Test {
 protected:
  Comparison compare(const FiberAssembly& fibers, const QueryOptions& options,
                     ProximityEngine& engine) {
    engine.update(fibers);
    return comparer_.compare(fibers, engine, options);
  }
  Comparison compare(const FiberAssembly& fibers, const QueryOptions& options) {
    return compare(fibers, options, *engine_);
  }

 private:
  FclComparer comparer_;
  std::unique_ptr<ProximityEngine> engine_ = make_engine("run_tree", {2});
};

/// Nothing is counted twice or left out, and the truth is what exact arithmetic says.
void expect_consistent(const Comparison& found) {
  EXPECT_EQ(found.styles[0].style, FclStyle::USER);
  EXPECT_EQ(found.styles[1].style, FclStyle::BEST);
  for (const StyleComparison& style : found.styles) {
    EXPECT_EQ(style.only_ours + style.in_both, found.contacts);
    EXPECT_EQ(style.only_fcl + style.in_both, style.contacts);
    EXPECT_GE(style.disagreements.size(), style.only_ours + style.only_fcl);
    for (const Disagreement& pair : style.disagreements) {
      EXPECT_TRUE(pair.ours || pair.fcl);
    }
  }
}

void expect_agreement(const StyleComparison& style) {
  EXPECT_EQ(style.only_ours + style.only_fcl + style.no_answer, 0U);
  EXPECT_TRUE(style.disagreements.empty());
}

/// FCL's tree over our boxes must find what brute force finds: our narrow phase is in both.
void expect_the_same(const StyleComparison& best) {
  expect_agreement(best);
  EXPECT_EQ(best.largest_difference, 0.0);
}

TEST_F(FclComparerTest, AgreesOnWhatIsClosedAndJoined) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::size_t contacts = 0;
  for (int round = 0; round < 30; ++round) {
    const FiberAssembly fibers = random_joined_fibers(random).assembly();
    QueryOptions options;
    options.margin = random.uniform(0.0, 0.3);
    set_neighbour_skips(options, random, 3, random.chance(0.5) ? random.uniform(0.0, 1.0) : 0.0);
    const Comparison found = compare(fibers, options);
    expect_consistent(found);
    expect_the_same(found.styles[1]);
    ASSERT_EQ(found.contacts, brute_force(fibers, options).contacts.size()) << skips_of(options);
    contacts += found.contacts;
  }
  expect_enough(contacts, std::size_t{100});
}

TEST_F(FclComparerTest, AgreesOnCablesAndSoup) {
  for (const char* name : {"cables", "soup"}) {
    const double scale = std::string(name) == "cables" ? 1.0 : 0.01;
    const Scene scene = make_scene(name, {scale, 1, false});
    std::uint64_t contacts = 0;
    for (std::uint32_t frame = 0; frame < 5; ++frame) {
      SCOPED_TRACE(std::string(name) + ", frame " + std::to_string(frame));
      QueryOptions options;
      options.margin = 0.005;
      const Comparison found = compare(scene(frame), options);
      expect_consistent(found);
      expect_agreement(found.styles[0]);
      expect_the_same(found.styles[1]);
      EXPECT_LT(found.styles[0].largest_difference, 1e-14);
      EXPECT_EQ(found.margin, 0.005);
      contacts += found.contacts;
      for (const StyleComparison& style : found.styles) {
        EXPECT_GT(style.update_time, 0.0);
        EXPECT_GT(style.detect_time, 0.0);
        EXPECT_GE(style.pair_tests, style.contacts);
      }
      EXPECT_GT(found.detect_time, 0.0);
    }
    EXPECT_GT(contacts, 10U) << name;
  }
}

TEST_F(FclComparerTest, NeverFindsUsWrong) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::vector<AssemblyFamily> families = assembly_families();
  for (const AssemblyFamily& family : hard_scenes()) {
    families.push_back(family);
  }
  for (const std::string& name : scene_names()) {
    families.push_back({name, [name](Random& r) { return SmallScene(name, false, true, r)(0); }});
  }
  for (const AssemblyFamily& family : families) {
    for (const Kernel kernel : {Kernel::ROBUST, Kernel::EXACT}) {
      SCOPED_TRACE(family.name + ", " + name_of(kernel));
      QueryOptions options;
      options.kernel = kernel;
      options.margin = random.chance(0.5) ? 0.0 : random.uniform(0.0, 0.05);
      options.neighbour_skip = static_cast<std::uint32_t>(random.integer(0, 2));
      const Comparison found = compare(family.make(random), options);
      expect_consistent(found);
      expect_the_same(found.styles[1]);
      ASSERT_TRUE(found.ours_is_right());
    }
  }
}

TEST_F(FclComparerTest, FollowsChangesOfMarginAndTopology) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < 40; ++round) {
    const FiberAssembly fibers = assembly_families()[0].make(random);
    QueryOptions options;
    options.margin = 0.01 * random.integer(0, 2);
    const Comparison found = compare(fibers, options);
    const QueryResult truth = brute_force(fibers, options);
    EXPECT_EQ(found.styles[0].contacts, truth.contacts.size());
    EXPECT_EQ(found.styles[1].contacts, truth.contacts.size());
  }
}

TEST_F(FclComparerTest, AsksForAllPairsWhateverTheType) {
  const FiberAssembly fibers = make_scene("cables", {0.05, 1, false})(0);
  QueryOptions options;
  options.margin = 0.01;
  options.neighbour_skip = 1;  // these cables make no loops
  const std::uint64_t contacts = compare(fibers, options).contacts;
  options.type = QueryType::FIRST;
  EXPECT_EQ(compare(fibers, options).contacts, contacts);
  EXPECT_GT(contacts, 1U);
}

TEST_F(FclComparerTest, TakesFibresWithoutAnyPair) {
  const FiberAssembly one({{0, 0, 0}, {1, 0, 0}}, {0, 2}, {0.1});
  for (const FiberAssembly& fibers : {FiberAssembly(), one}) {
    const Comparison found = compare(fibers, {});
    EXPECT_EQ(found.contacts, 0U);
    expect_agreement(found.styles[0]);
  }
}

TEST_F(FclComparerTest, RefusesMarginsThatBoxesCannotHold) {
  QueryOptions options;
  options.margin = std::numeric_limits<double>::infinity();
  EXPECT_THROW(compare(FiberAssembly(), options), std::invalid_argument);
  options.margin = -1.0;
  EXPECT_THROW(compare(FiberAssembly(), options), std::invalid_argument);
}

// What FCL is blamed for must not come from the pose we give it.
TEST_F(FclComparerTest, PlacesCapsulesThatPointAlmostDown) {
  for (const double tilt : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
    const FiberAssembly fibers({{0, 0, 1}, {tilt, 0, 0}, {0.02, -0.1, 0}, {0.02, 0.1, 0}},
                               {0, 2, 4}, {0.015});
    const Comparison found = compare(fibers, {});
    EXPECT_EQ(found.contacts, 1U);
    expect_agreement(found.styles[0]);
    EXPECT_LT(found.styles[0].largest_difference, 1e-15) << tilt;
  }
}

// FCL takes two segments for parallel whose lengths to the fourth, times the squared sine of their
// angle, are less than 4e-28 m⁴: those of a tenth of a micrometre whatever the angle.
TEST_F(FclComparerTest, ProvesFclWrongAboutTinySegments) {
  const FiberAssembly fibers({{-5e-8, 0, 0}, {5e-8, 0, 0}, {0, -5e-8, 2e-8}, {0, 5e-8, 2e-8}},
                             {0, 2, 4}, {1.1e-8});
  const Comparison found = compare(fibers, {});
  const StyleComparison& user = found.styles[0];
  expect_the_same(found.styles[1]);
  EXPECT_EQ(user.only_ours, 1U);
  ASSERT_EQ(user.disagreements.size(), 1U);
  const Disagreement& pair = user.disagreements.front();
  EXPECT_EQ(pair.a.fiber, 0U);
  EXPECT_EQ(pair.b.fiber, 1U);
  ASSERT_TRUE(pair.ours);
  EXPECT_FALSE(pair.fcl);
  EXPECT_TRUE(pair.fcl_has_answer);
  EXPECT_TRUE(pair.is_contact);
  EXPECT_NEAR(pair.gap, -2e-9, 1e-22);
  EXPECT_EQ(pair.verdict, Verdict::OURS);
  EXPECT_TRUE(found.ours_is_right());
  EXPECT_EQ(found.count(Verdict::OURS), 1U);
}

// Where they are contacts by either, the distance that FCL computes of them is wrong.
TEST_F(FclComparerTest, ProvesFclsDistanceWrong) {
  const FiberAssembly fibers({{-5e-8, 0, 0}, {5e-8, 0, 0}, {0, -5e-8, 2e-8}, {0, 5e-8, 2e-8}},
                             {0, 2, 4}, {1e-7});
  const StyleComparison user = compare(fibers, {}).styles[0];
  EXPECT_EQ(user.in_both, 1U);
  EXPECT_GT(user.largest_difference, 1e-8);
  EXPECT_EQ(user.largest_b.fiber, 1U);
  ASSERT_EQ(user.disagreements.size(), 1U);
  EXPECT_EQ(user.disagreements.front().verdict, Verdict::OURS);
}

// By cancellation FCL loses half the digits there.
TEST_F(FclComparerTest, ProvesFclWrongNearParallel) {
  const Eigen::Vector3d along(0.36, 0.48, 0.8);
  const Eigen::Vector3d across(0.8, -0.6, 0.0);
  const Eigen::Vector3d other = along + 1e-7 * across;
  const Eigen::Vector3d crossing(0.1, 0.2, 0.3);
  const FiberAssembly fibers({crossing - 0.7 * along, crossing + 0.3 * along,
                              crossing - 0.6 * other, crossing + 0.4 * other},
                             {0, 2, 4}, {0.01});
  const Comparison found = compare(fibers, {});
  const StyleComparison& user = found.styles[0];
  EXPECT_EQ(user.in_both, 1U);
  EXPECT_GT(user.largest_difference, 1e-11);
  ASSERT_EQ(user.disagreements.size(), 1U);
  EXPECT_EQ(user.disagreements.front().verdict, Verdict::OURS);
  expect_the_same(found.styles[1]);
}

// Beyond about 1e77 m FCL's fourth powers are infinite.
TEST_F(FclComparerTest, TellsWhereFclHasNoAnswer) {
  const FiberAssembly fibers({{-1e90, 0, 0}, {1e90, 0, 0}, {0, -1e90, 1e88}, {0, 1e90, 1e88}},
                             {0, 2, 4}, {1e89});
  const Comparison found = compare(fibers, {});
  const StyleComparison& user = found.styles[0];
  EXPECT_EQ(user.no_answer, 1U);
  EXPECT_EQ(user.only_ours, 1U);
  EXPECT_EQ(user.contacts, 0U);
  ASSERT_EQ(user.disagreements.size(), 1U);
  EXPECT_FALSE(user.disagreements.front().fcl_has_answer);
  EXPECT_EQ(user.disagreements.front().verdict, Verdict::OURS);
}

/// Brute force whose answer is changed before it is given.
class BrokenEngine final : public ProximityEngine {
 public:
  using Change = std::function<void(std::vector<Contact>& contacts)>;
  explicit BrokenEngine(Change change) : change_(std::move(change)) {}

 protected:
  void do_update(const FiberAssembly& /*fibers*/, bool /*same_topology*/) override {}
  void do_query(const FiberAssembly& fibers, const QueryOptions& options,
                QueryResult& result) const override {
    result = brute_force(fibers, options);
    change_(result.contacts);
  }
  void do_query_shape(const FiberAssembly& /*shape*/, const FiberAssembly& /*fibers*/,
                      const QueryOptions& /*options*/, QueryResult& /*result*/) const override {}

 private:
  Change change_;
};

/// Two fibres that cross, and one that touches nothing.
FiberAssembly crossing() {
  return {{{-1, 0, 0}, {1, 0, 0}, {0, -1, 0.5}, {0, 1, 0.5}, {-1, 0, 3}, {1, 0, 3}},
          {0, 2, 4, 6},
          {0.3}};
}

class BrokenEngineTest : public FclComparerTest {
 protected:
  /// The only disagreement of both styles, which FCL must win.
  Disagreement disagreement(const BrokenEngine::Change& change, Kernel kernel = Kernel::ROBUST) {
    BrokenEngine engine(change);
    QueryOptions options;
    options.kernel = kernel;
    const Comparison found = compare(crossing(), options, engine);
    expect_consistent(found);
    EXPECT_FALSE(found.ours_is_right());
    EXPECT_EQ(found.count(Verdict::FCL), 2U);
    for (const StyleComparison& style : found.styles) {
      EXPECT_EQ(style.disagreements.size(), 1U);
      EXPECT_EQ(style.count(Verdict::FCL), 1U);
    }
    return found.styles[1].disagreements.at(0);
  }
};

TEST_F(BrokenEngineTest, IsFoundOutWhenItLeavesAPairOut) {
  for (const Kernel kernel : {Kernel::ROBUST, Kernel::EXACT}) {
    const Disagreement pair =
        disagreement([](std::vector<Contact>& contacts) { contacts.clear(); }, kernel);
    EXPECT_EQ(pair.a.fiber, 0U);
    EXPECT_EQ(pair.b.fiber, 1U);
    EXPECT_FALSE(pair.ours);
    ASSERT_TRUE(pair.fcl);
    EXPECT_NEAR(pair.fcl->gap, -0.1, 1e-6);
    EXPECT_TRUE(pair.is_contact);
  }
}

TEST_F(BrokenEngineTest, IsFoundOutWhenItInventsAPair) {
  const Disagreement pair = disagreement([](std::vector<Contact>& contacts) {
    contacts.push_back(contacts.front());
    contacts.back().fiber_b = 2;
  });
  EXPECT_EQ(pair.b.fiber, 2U);
  EXPECT_TRUE(pair.ours);
  EXPECT_FALSE(pair.fcl);
  EXPECT_FALSE(pair.is_contact);
  EXPECT_NEAR(pair.gap, 2.4, 1e-9);
}

TEST_F(BrokenEngineTest, IsFoundOutWhenADistanceIsWrong) {
  for (const double wrong : {-0.2, -0.1 + 1e-12, std::nan("")}) {
    const Disagreement pair = disagreement([=](std::vector<Contact>& contacts) {
      contacts.front().distance = contacts.front().lower = contacts.front().upper = wrong;
    });
    ASSERT_TRUE(pair.ours && pair.fcl);
    EXPECT_NEAR(pair.fcl->gap, -0.1, 1e-15);
  }
}

}  // namespace
}  // namespace fiber::test

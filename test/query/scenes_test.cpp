// The paper's scenes, small: every engine gives brute force's contacts, at a cost that adds up.
#include <gtest/gtest.h>

#include <algorithm>

#include "src/bounds/aabb.hpp"
#include "src/paper/engines/hierarchy_engine.hpp"
#include "src/paper/hierarchy/hierarchy.hpp"
#include "test/support/answers.hpp"
#include "test/support/contacts.hpp"
#include "test/support/engine_names.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"
#include "test/support/small_scene.hpp"

namespace fiber::test {
namespace {

constexpr double margins[] = {0.0, 0.5, 4.0};  // [radii]

std::vector<std::string> engines_under_test() {
  register_paper_engines();  // all of them, as it is their trees that are compared
  std::vector<std::string> names = engine_names();
  names.insert(names.end(), {"DL-6", "DS-6", "DL-14-classic", "DS-14-classic"});
  names.erase(std::find(names.begin(), names.end(), "brute_force"));
  return names;
}

template <class Element>
std::vector<Element*> pointers_to(std::vector<Element>& elements) {
  std::vector<Element*> pointers;
  for (Element& element : elements) {
    pointers.push_back(&element);
  }
  return pointers;
}

class ScenesAgreementTest : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    for (const std::string& name : engines_under_test()) {
      engines_.emplace_back(name, make_engine(name));
    }
  }

  /// Some engines are enough for a scene where all have their turns in other ones.
  void keep_some_engines() {
    Random random(scene_index());
    std::vector<std::pair<std::string, std::unique_ptr<ProximityEngine>>> some;
    for (auto* engine : sampled(pointers_to(engines_), random)) {
      some.push_back(std::move(*engine));
    }
    engines_ = std::move(some);
  }

  /// Holds all engines, updated to these fibres, against brute force at every margin.
  void compare(const FiberAssembly& fibers, double radius) {
    for (const auto& [name, engine] : engines_) {
      engine->update(fibers);
    }
    for (const double margin : margins) {
      QueryOptions options = within(margin * radius);
      const QueryResult expected = brute_force(fibers, options);
      contacts_ += expected.contacts.size();
      for (const auto& [name, engine] : engines_) {
        ASSERT_TRUE(same_contacts(answer(*engine, options).contacts, expected.contacts))
            << name << ", margin " << margin << " radii, " << fibers.segment_count() << " segments";
      }
    }
  }

  /// Calls `check` with small scenes of this name: styled and shuffled, thin and thick.
  template <class Check>
  void for_small_scenes(int rounds, const Check& check) {
    SCOPED_TRACE(seed_message());
    Random random(scene_index());
    for (int round = 0; round < rounds; ++round) {
      for (const bool shuffle : {false, true}) {
        for (const bool thick : {false, true}) {
          SCOPED_TRACE(testing::Message() << "round " << round << (shuffle ? ", shuffled" : "")
                                          << (thick ? ", thick" : ""));
          const SmallScene scene(GetParam(), shuffle, thick, random);
          ASSERT_NO_FATAL_FAILURE(check(scene, random));
        }
      }
    }
  }

  static std::uint64_t scene_index() {
    const std::vector<std::string> names = scene_names();
    const auto found = std::find(names.begin(), names.end(), GetParam());
    return static_cast<std::uint64_t>(found - names.begin());
  }

  std::vector<std::pair<std::string, std::unique_ptr<ProximityEngine>>> engines_;
  std::size_t contacts_ = 0;  // seen so far
};

TEST_P(ScenesAgreementTest, EveryEngineGivesBruteForcesContactsInMovingFrames) {
  keep_some_engines();
  for_small_scenes(rounds(3), [this](const SmallScene& scene, Random& random) {
    const auto frame = static_cast<std::uint32_t>(random.integer(0, 1000));
    const auto later = static_cast<std::uint32_t>(random.integer(1, 50));  // half a sway
    FiberAssembly fibers = scene(frame);
    const std::vector<Eigen::Vector3d> before = fibers.points();
    ASSERT_NO_FATAL_FAILURE(compare(fibers, scene.radius()));
    fibers.update_points(scene(frame + later).points());
    ASSERT_NE(fibers.points(), before);
    ASSERT_NO_FATAL_FAILURE(compare(fibers, scene.radius())) << "after a refit";
  });
  expect_enough(contacts_, std::size_t{101});
}

TEST_P(ScenesAgreementTest, TheLeafPretestChangesOnlyTheCost) {
  keep_some_engines();
  for_small_scenes(1, [this](const SmallScene& scene, Random& random) {
    const FiberAssembly fibers = scene(static_cast<std::uint32_t>(random.integer(0, 1000)));
    for (const double margin : margins) {
      QueryOptions options = within(margin * scene.radius());
      const std::uint64_t all_pairs = brute_force(fibers, options).counts.primitive_tests;
      for (const auto& [name, engine] : engines_) {
        SCOPED_TRACE(testing::Message() << name << ", margin " << margin << " radii");
        engine->update(fibers);
        set_leaf_pretest(*engine, true);
        const QueryResult with = answer(*engine, options);
        set_leaf_pretest(*engine, false);
        const QueryResult without = answer(*engine, options);
        ASSERT_TRUE(same_contacts(without.contacts, with.contacts));
        EXPECT_LE(with.contacts.size(), with.counts.primitive_tests);
        EXPECT_LE(with.counts.primitive_tests, without.counts.primitive_tests);
        EXPECT_LE(without.counts.primitive_tests, all_pairs);
        if (name != "run_tree") {  // which always tests them
          EXPECT_LT(without.counts.node_tests, with.counts.node_tests);
        }
      }
    }
  });
}

// A node of boxes or k-DOPs holds its children's volumes, whatever the tree: what remains after the
// pre-test are the pairs of leaves that overlap. Sect. 5 of the paper finds it nearly so for all.
TEST_P(ScenesAgreementTest, TreesOfTheSameDopsTestTheSamePrimitives) {
  const std::vector<std::vector<std::string>> alike{{"AL", "AL-threaded", "AS"},
                                                    {"DL-20", "DS-20"},
                                                    {"DL-6", "DS-6"},
                                                    {"DL-14-classic", "DS-14-classic"}};
  for_small_scenes(1, [&](const SmallScene& scene, Random& random) {
    const FiberAssembly fibers = scene(static_cast<std::uint32_t>(random.integer(0, 1000)));
    for (const double margin : margins) {
      QueryOptions options = within(margin * scene.radius());
      for (const std::vector<std::string>& names : alike) {
        std::vector<std::uint64_t> tests;
        for (const auto& [name, engine] : engines_) {
          if (std::find(names.begin(), names.end(), name) != names.end()) {
            engine->update(fibers);
            tests.push_back(answer(*engine, options).counts.primitive_tests);
          }
        }
        ASSERT_EQ(tests, std::vector<std::uint64_t>(names.size(), tests.front())) << names.front();
      }
    }
  });
}

// Sect. 4.2.2: wrapping a k-DOP gives what layering gives, so a query does the same work.
TEST_P(ScenesAgreementTest, WrappedBoxesCostWhatLayeredOnesDo) {
  for_small_scenes(1, [](const SmallScene& scene, Random& random) {
    const FiberAssembly fibers = scene(static_cast<std::uint32_t>(random.integer(0, 1000)));
    HierarchyEngine<LayeredHierarchy<Aabb>> layered{LayeredHierarchy<Aabb>()};
    HierarchyEngine<WrappedHierarchy<Aabb>> wrapped{WrappedHierarchy<Aabb>()};
    layered.update(fibers);
    wrapped.update(fibers);
    for (const bool leaf_pretest : {false, true}) {
      QueryOptions options;
      options.margin = scene.radius();
      layered.set_leaf_pretest(leaf_pretest);
      wrapped.set_leaf_pretest(leaf_pretest);
      const QueryCounts one = answer(layered, options).counts;
      const QueryCounts other = answer(wrapped, options).counts;
      EXPECT_EQ(one.node_tests, other.node_tests);
      EXPECT_EQ(one.node_overlaps, other.node_overlaps);
      EXPECT_EQ(one.primitive_tests, other.primitive_tests);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Scenes, ScenesAgreementTest, testing::ValuesIn(scene_names()),
                         [](const auto& instance) { return test_name(instance.param); });

}  // namespace
}  // namespace fiber::test

// Queries whose bound shrinks, of scenes large enough that several threads share the search.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"
#include "test/support/not_finite.hpp"
#include "test/support/tangle.hpp"

namespace fiber::test {
namespace {

struct Asked {
  const char* name;
  QueryOptions options;
};

/// Every type, with limits of all sizes that end a search in its rounds.
std::vector<Asked> all_kinds() {
  std::vector<Asked> kinds;
  kinds.push_back({"first", within(0.02, QueryType::FIRST)});
  kinds.push_back({"first", within(infinity, QueryType::FIRST)});
  kinds.push_back({"closest", within(infinity, QueryType::CLOSEST)});
  kinds.push_back({"limited", within(0.02, QueryType::LIMITED)});
  kinds.back().options.max_contacts = 40;
  kinds.push_back({"limited", within(infinity, QueryType::LIMITED)});
  kinds.back().options.max_contacts = 3000;
  kinds.push_back({"fiber_pairs", within(0.02, QueryType::FIBER_PAIRS)});
  kinds.push_back({"fiber_pairs, limited", within(0.1, QueryType::FIBER_PAIRS)});
  kinds.back().options.contact_limit = 50;
  kinds.push_back({"no self-contacts", within(infinity, QueryType::LIMITED)});
  kinds.back().options.pairing = Pairing::DIFFERENT_FIBERS;
  return kinds;
}

class ShrinkingSearchTest : public testing::Test {
 protected:
  void update(const FiberAssembly& fibers) {
    one_->update(fibers);
    four_->update(fibers);
  }

  /// The answer of one thread, which that of four threads must equal.
  template <class... Shape>
  const QueryResult& ask(const QueryOptions& options, const Shape&... shape) {
    found_ = answer(*one_, shape..., options);
    const QueryResult of_four = answer(*four_, shape..., options);
    EXPECT_TRUE(same_contacts(found_.contacts, of_four.contacts));
    EXPECT_EQ(found_.complete, of_four.complete);
    EXPECT_EQ(found_.limit_reached, of_four.limit_reached);
    EXPECT_EQ(found_.others_lower, of_four.others_lower);
    EXPECT_EQ(found_.counts.primitive_tests, of_four.counts.primitive_tests);
    EXPECT_EQ(found_.counts.node_tests, of_four.counts.node_tests);
    return found_;
  }

  const std::unique_ptr<ProximityEngine> one_ = make_engine("run_tree", {1, 0.0});
  const std::unique_ptr<ProximityEngine> four_ = make_engine("run_tree", {4, 0.0});
  QueryResult found_;
};

/// Whether all pairs that are not reported are as far as others_lower says.
void expect_bound(const QueryResult& found, const std::vector<Contact>& all) {
  std::size_t next = 0;
  for (const Contact& contact : all) {
    while (next < found.contacts.size() && found.contacts[next].key() < contact.key()) {
      ++next;
    }
    if (next == found.contacts.size() || found.contacts[next].key() != contact.key()) {
      ASSERT_GE(contact.upper, found.others_lower) << "of a pair that is not reported";
    }
  }
}

TEST_F(ShrinkingSearchTest, FindsWhatBruteForceFindsOnAnyNumberOfThreads) {
  SCOPED_TRACE(seed_message());
  Random random;
  const std::vector<FiberAssembly> scenes{
      walks(random, 240, 10, 0.05, 1e-3),  // sparse
      walks(random, 4, 600, 0.05, 0.02),   // each fibre beside itself
      walks(random, 1100, 2, 1e-3, 0.3),   // all as deep as can be
      tangle(random, 200),                 // dense
  };
  for (std::size_t scene = 0; scene < scenes.size(); ++scene) {
    const FiberAssembly& fibers = scenes[scene];
    ASSERT_GT(fibers.segment_count(), 2048U) << "too small for rounds of several jobs";
    update(fibers);
    const std::vector<Contact> near = brute_force(fibers, within(0.02)).contacts;
    for (const Asked& asked : all_kinds()) {
      SCOPED_TRACE(std::string(asked.name) + ", scene " + std::to_string(scene) + ", margin " +
                   std::to_string(asked.options.margin));
      const QueryResult& found = ask(asked.options);
      EXPECT_TRUE(found.complete);
      if (asked.options.type == QueryType::FIRST) {
        ASSERT_EQ(found.contacts.size(), near.empty() && asked.options.margin == 0.02 ? 0U : 1U);
        continue;
      }
      const QueryResult expected = brute_force(fibers, asked.options);
      ASSERT_TRUE(same_contacts(found.contacts, expected.contacts));
      EXPECT_EQ(found.limit_reached, expected.limit_reached);
      if (asked.options.pairing == Pairing::ALL) {
        ASSERT_NO_FATAL_FAILURE(expect_bound(found, near));
      }
    }
  }
}

TEST_F(ShrinkingSearchTest, EndsWhereThePairsRunOutOnAnyNumberOfThreads) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = tangle(random, 1000);
  update(fibers);
  int complete = 0;
  int cut = 0;
  for (Asked asked : all_kinds()) {
    for (std::uint64_t pairs = 100; pairs < 3'000'000; pairs *= 3) {
      SCOPED_TRACE(std::string(asked.name) + ", " + std::to_string(pairs) + " pairs, margin " +
                   std::to_string(asked.options.margin));
      asked.options.pair_limit = pairs;
      const QueryResult& found = ask(asked.options);
      EXPECT_LE(found.counts.primitive_tests, pairs);
      ++(found.complete ? complete : cut);
      if (!found.complete) {
        EXPECT_TRUE(found.limit_reached);
      }
    }
  }
  EXPECT_GT(complete, 20);
  EXPECT_GT(cut, 20);
}

TEST_F(ShrinkingSearchTest, ToleratesTheSameOnAnyNumberOfThreads) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = walks(random, 600, 10, 0.05, 1e-3);
  update(fibers);
  for (Asked asked : all_kinds()) {
    SCOPED_TRACE(asked.name);
    asked.options.tolerance = 0.01;
    asked.options.relative_tolerance = 0.1;
    const QueryResult& found = ask(asked.options);
    EXPECT_TRUE(found.complete);
    ASSERT_FALSE(found.contacts.empty());
  }
}

TEST_F(ShrinkingSearchTest, FindsAContactWhereverItIs) {
  // One fibre touches the next one among straight ones: in each part of the search once.
  constexpr int fiber_count = 1000;
  constexpr int segment_count = 8;
  for (const int touching : {0, 7, 130, 400, 555, 871, 998}) {
    SCOPED_TRACE(touching);
    AssemblyBuilder builder;
    for (int fiber = 0; fiber < fiber_count; ++fiber) {
      std::vector<Eigen::Vector3d> points;
      for (int point = 0; point <= segment_count; ++point) {
        const bool reaches = fiber == touching && point == segment_count / 2;
        points.emplace_back(0.1 * point, fiber + (reaches ? 1.0 : 0.0), 0.0);
      }
      builder.add_fiber(points);
    }
    const FiberAssembly fibers = builder.build({0.01});
    update(fibers);
    const QueryResult& found = ask(within(0.05, QueryType::FIRST));
    ASSERT_EQ(found.contacts.size(), 1U);
    EXPECT_EQ(found.contacts[0].fiber_a, static_cast<std::uint32_t>(touching));
    EXPECT_EQ(found.contacts[0].fiber_b, static_cast<std::uint32_t>(touching) + 1);
  }
}

TEST_F(ShrinkingSearchTest, AnswersAboutAShapeOfManySegments) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = walks(random, 20, 10, 0.05, 1e-3);
  const FiberAssembly shape = walks(random, 200, 10, 0.05, 1e-3);
  update(fibers);
  for (const Asked& asked : all_kinds()) {
    SCOPED_TRACE(asked.name);
    const QueryResult& found = ask(asked.options, shape);
    EXPECT_TRUE(found.complete);
    if (asked.options.type != QueryType::FIRST) {
      EXPECT_TRUE(
          same_contacts(found.contacts, brute_force(shape, fibers, asked.options).contacts));
    }
  }
}

}  // namespace
}  // namespace fiber::test

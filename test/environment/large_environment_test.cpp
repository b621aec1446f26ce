// Queries of scenes large enough that several threads share them.
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "test/environment/environment_queries.hpp"
#include "test/support/contacts.hpp"

namespace fiber::test {
namespace {

struct Asked {
  std::string name;
  QueryOptions options;
};

/// Every type, near and far, with few and with many contacts to report.
std::vector<Asked> all_kinds() {
  std::vector<Asked> kinds;
  const auto add = [&](const std::string& name, QueryType type, double margin) -> QueryOptions& {
    kinds.push_back({name + ", margin " + std::to_string(margin), {}});
    kinds.back().options.type = type;
    kinds.back().options.margin = margin;
    return kinds.back().options;
  };
  for (const double margin : {0.0, 0.05, infinity}) {
    add("first", QueryType::FIRST, margin);
    add("closest", QueryType::CLOSEST, margin);
    add("the 40 closest", QueryType::LIMITED, margin).max_contacts = 40;
    add("the 2000 closest", QueryType::LIMITED, margin).max_contacts = 2000;
    add("fibre pairs", QueryType::FIBER_PAIRS, margin);
    add("all", QueryType::ALL, margin);
  }
  add("all, up to 50", QueryType::ALL, 0.05).contact_limit = 50;
  return kinds;
}

class LargeEnvironment : public testing::Test {
 protected:
  /// The answer of one thread, which that of four threads must equal.
  QueryResult ask(const FiberAssembly& fibers, const QueryOptions& options) {
    QueryResult of_one;
    QueryResult of_four;
    tbb::task_arena(1).execute([&] { of_one = test::ask(environment_, fibers, options); });
    tbb::task_arena(4).execute([&] { of_four = test::ask(environment_, fibers, options); });
    EXPECT_TRUE(same_contacts(of_one.contacts, of_four.contacts));
    EXPECT_EQ(of_one.complete, of_four.complete);
    EXPECT_EQ(of_one.limit_reached, of_four.limit_reached);
    EXPECT_EQ(of_one.others_lower, of_four.others_lower);
    if (options.type != QueryType::FIRST) {
      EXPECT_EQ(of_one.counts.primitive_tests, of_four.counts.primitive_tests);
      EXPECT_EQ(of_one.counts.node_tests, of_four.counts.node_tests);
    }
    return of_one;
  }

  Random random_;
  const std::vector<EnvironmentObject> objects_ = random_objects(random_, 1.0);
  const Environment environment_{objects_};
};

TEST_F(LargeEnvironment, ReportsWhatBruteForceReportsOnAnyNumberOfThreads) {
  SCOPED_TRACE(seed_message());
  // Many short fibres, of which jobs have hundreds, and a few that are longer than a job.
  for (const auto& [count, most] : {std::pair(600, 20), std::pair(3, 4000)}) {
    const FiberAssembly fibers = random_fibers(random_, 1.0, count, most);
    const std::vector<Contact> pairs = all_pairs(fibers, objects_);
    for (const Asked& asked : all_kinds()) {
      SCOPED_TRACE(asked.name + ", " + std::to_string(fibers.point_count()) + " points");
      const QueryResult found = ask(fibers, asked.options);
      const std::vector<Contact> wanted = expected(pairs, asked.options);
      if (asked.options.type == QueryType::FIRST) {
        QueryOptions any = asked.options;
        any.type = QueryType::CLOSEST;
        EXPECT_TRUE(found.complete);
        ASSERT_EQ(found.contacts.size(), expected(pairs, any).size());
        continue;
      }
      if (asked.options.contact_limit > 0) {
        EXPECT_EQ(found.contacts.size(), asked.options.contact_limit);
        EXPECT_TRUE(found.limit_reached);
        continue;
      }
      EXPECT_TRUE(found.complete);
      ASSERT_EQ(found.contacts.size(), wanted.size());
      for (std::size_t i = 0; i < wanted.size(); ++i) {
        ASSERT_EQ(found.contacts[i].key(), wanted[i].key());
        ASSERT_NEAR(found.contacts[i].distance, wanted[i].distance, 1e-13);
      }
    }
  }
}

TEST_F(LargeEnvironment, EndsWhereThePairsRunOutOnAnyNumberOfThreads) {
  SCOPED_TRACE(seed_message());
  const FiberAssembly fibers = random_fibers(random_, 1.0, 600, 20);
  int complete = 0;
  int cut = 0;
  for (Asked asked : all_kinds()) {
    if (asked.options.type == QueryType::FIRST) {
      continue;  // which contact it is that is enough may come before the pairs run out, or after
    }
    for (std::uint64_t pairs = 10; pairs < 300'000; pairs *= 6) {
      SCOPED_TRACE(asked.name + ", " + std::to_string(pairs) + " pairs");
      asked.options.pair_limit = pairs;
      const QueryResult found = ask(fibers, asked.options);
      EXPECT_LE(found.counts.primitive_tests, pairs);
      EXPECT_TRUE(found.complete || found.limit_reached);
      ++(found.complete ? complete : cut);
    }
  }
  EXPECT_GT(complete, 10);
  EXPECT_GT(cut, 10);
}

TEST_F(LargeEnvironment, FindsAContactWhereverItIs) {
  // One of many straight fibres reaches a ball.
  const std::vector<EnvironmentObject> ball{
      {"ball", Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, 1.0)), {{SphereShape{0.5}}}}};
  const Environment environment(ball);
  for (const int touching : {0, 40, 230, 500, 999}) {
    SCOPED_TRACE(touching);
    std::vector<Eigen::Vector3d> points;
    std::vector<std::uint32_t> offsets{0};
    for (int fiber = 0; fiber < 1000; ++fiber) {
      for (int point = 0; point < 9; ++point) {
        points.emplace_back(point - 4.0, 1e-4 * fiber, fiber == touching ? 0.6 : -1.0);
      }
      offsets.push_back(static_cast<std::uint32_t>(points.size()));
    }
    QueryOptions options;
    options.type = QueryType::FIRST;
    options.margin = 0.2;
    for (const int threads : {1, 4}) {
      QueryResult found;
      tbb::task_arena(threads).execute([&] {
        environment.query({points, offsets, {0.001}}, options, {}, found);
      });
      ASSERT_EQ(found.contacts.size(), 1U);
      EXPECT_EQ(found.contacts[0].fiber_a, static_cast<std::uint32_t>(touching));
    }
  }
}

}  // namespace
}  // namespace fiber::test

// Queries are const: several threads may ask one engine at once.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <set>
#include <thread>

#include "fiber_proximity/paper/paper_engines.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/query/run_tree_engine.hpp"
#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"
#include "test/support/engines_test.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

constexpr QueryType types[] = {QueryType::ALL, QueryType::FIRST, QueryType::CLOSEST,
                               QueryType::LIMITED};

/// The engine's answers of every type about its fibres, then about the shape.
std::vector<QueryResult> ask_everything(const ProximityEngine& engine, const FiberAssembly& shape) {
  std::vector<QueryResult> answers;
  for (const QueryType type : types) {
    answers.push_back(answer(engine, within(0.1, type)));
    answers.push_back(answer(engine, shape, within(0.1, type)));
  }
  return answers;
}

class ConcurrentQueriesTest : public testing::TestWithParam<std::string> {};

TEST_P(ConcurrentQueriesTest, AreAnsweredAsOneAfterAnother) {
  SCOPED_TRACE(seed_message());
  Random random;
  AssemblyBuilder fiber_builder;
  AssemblyBuilder shape_builder;
  for (int fiber = 0; fiber < 80; ++fiber) {
    AssemblyBuilder& builder = fiber % 10 == 0 ? shape_builder : fiber_builder;
    builder.add_fiber(random_walk(random, 8, 0.1));
  }
  const FiberAssembly fibers = fiber_builder.build({0.01});
  const FiberAssembly shape = shape_builder.build({0.01});
  const auto engine = make_engine(GetParam(), {2});
  engine->update(fibers);

  constexpr int thread_count = 3;
  std::vector<std::vector<QueryResult>> found(thread_count);
  std::vector<std::thread> threads;
  threads.reserve(thread_count);
  for (std::vector<QueryResult>& answers : found) {
    threads.emplace_back([&] { answers = ask_everything(*engine, shape); });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  const std::vector<QueryResult> expected = ask_everything(*engine, shape);
  for (const std::vector<QueryResult>& answers : found) {
    ASSERT_EQ(answers.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_FALSE(expected[i].contacts.empty());
      EXPECT_TRUE(same_contacts(answers[i].contacts, expected[i].contacts)) << "query " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, ConcurrentQueriesTest, all_engines(), name_of_engine);

/// One of them chooses the skin, for all.
TEST(ConcurrentQueries, AreAnsweredWhileASkinIsChosen) {
  SCOPED_TRACE(seed_message());
  Random random;
  AssemblyBuilder builder;
  for (int fiber = 0; fiber < 600; ++fiber) {
    builder.add_fiber(random_walk(random, 20, 0.05));
  }
  FiberAssembly fibers = builder.build({0.002});
  const QueryOptions options = within(0.01, QueryType::ALL);
  // More than may work at the same time: those that work take up what the others ask.
  constexpr int thread_count = 6;
  constexpr int frames = 4;
  std::uint64_t served = 0;
  for (int round = 0; round < rounds(40); ++round) {
    RunTreeEngine engine({2});
    for (int frame = 0; frame < frames; ++frame) {
      engine.update(fibers);
      std::vector<QueryResult> found(thread_count);
      std::vector<std::thread> threads;
      threads.reserve(thread_count);
      for (QueryResult& result : found) {
        // Most come while the first one is at it.
        threads.emplace_back([&, wait = std::chrono::microseconds(random.integer(0, 500))] {
          std::this_thread::sleep_for(wait);
          engine.query(options, result);
        });
      }
      for (std::thread& thread : threads) {
        thread.join();
      }
      EXPECT_FALSE(found.front().contacts.empty());
      for (const QueryResult& result : found) {
        ASSERT_TRUE(same_contacts(result.contacts, found.front().contacts)) << "round " << round;
      }
    }
    served += frames - engine.refit_count();
  }
  EXPECT_GT(served, 0U);
}

TEST(PaperEngines, AreThereOnceWhoeverRegistersThem) {
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back(register_paper_engines);
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  register_paper_engines();
  const std::vector<std::string> names = engine_names();
  EXPECT_EQ(std::count(names.begin(), names.end(), "AL"), 1);
  EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
  EXPECT_NE(make_engine("AL"), nullptr);
}

}  // namespace
}  // namespace fiber::test

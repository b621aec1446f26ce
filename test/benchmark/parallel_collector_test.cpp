#include "benchmark/peers/parallel_collector.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"

namespace fiber::test {
namespace {

TEST(ParallelCollector, GivesBruteForcesAnswerFromAnyNumberOfThreads) {
  SCOPED_TRACE(seed_message());
  Random random;
  ParallelCollector collector;  // kept, as an engine does
  for (int round = 0; round < 20; ++round) {
    const FiberAssembly fibers = walks(random, 1, 60, 0.05, 0.02);
    const QueryResult expected = brute_force(fibers);

    const auto thread_count = static_cast<std::uint32_t>(random.integer(1, 4));
    const QueryOptions options;
    QueryResult found;
    collector.collect(fibers, options, found, [&](ParallelCollector& shared) {
      std::vector<std::thread> threads;
      for (std::uint32_t thread = 0; thread < thread_count; ++thread) {
        threads.emplace_back([&shared, &fibers, thread, thread_count] {
          for (std::uint32_t i = thread; i < fibers.segment_count(); i += thread_count) {
            for (std::uint32_t j = i + 1; j < fibers.segment_count(); ++j) {
              shared.local().offer(i, j);
            }
          }
        });
      }
      for (std::thread& thread : threads) {
        thread.join();
      }
    });
    EXPECT_TRUE(same_contacts(found.contacts, expected.contacts)) << thread_count << " threads";
    EXPECT_EQ(found.counts.primitive_tests, expected.counts.primitive_tests);
  }
}

}  // namespace
}  // namespace fiber::test

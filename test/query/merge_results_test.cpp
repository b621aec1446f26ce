#include <gtest/gtest.h>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/options.hpp"

namespace fiber {
namespace {

/// Of fibres a and b, at this distance, known to a tenth.
Contact contact(std::uint32_t fiber_a, std::uint32_t segment_a, std::uint32_t fiber_b,
                double distance) {
  Contact made;
  made.fiber_a = fiber_a;
  made.segment_a = segment_a;
  made.fiber_b = fiber_b;
  made.distance = distance;
  made.lower = distance - 0.1;
  made.upper = distance + 0.1;
  return made;
}

/// Segments of a and distances of contacts, in their order.
std::vector<std::pair<std::uint32_t, double>> join(const QueryResult& result) {
  std::vector<std::pair<std::uint32_t, double>> all;
  for (const Contact& each : result.contacts) {
    all.emplace_back(each.segment_a, each.distance);
  }
  return all;
}

using Listed = std::vector<std::pair<std::uint32_t, double>>;

QueryResult merged(QueryType type) {
  QueryOptions options;
  options.type = type;
  options.max_contacts = 2;
  QueryResult result;
  result.contacts = {contact(0, 5, 0, 2.0), contact(0, 2, 1, 3.0)};
  result.others_lower = 9.0;
  result.counts = {1, 2, 3};
  QueryResult more;
  more.contacts = {contact(0, 3, 0, 1.0), contact(0, 4, 0, 1.5)};
  more.others_lower = 8.0;
  more.counts = {10, 20, 30};
  merge_results(options, more, result);
  EXPECT_EQ(result.counts.node_tests, 11U);
  EXPECT_EQ(result.counts.node_overlaps, 22U);
  EXPECT_EQ(result.counts.primitive_tests, 33U);
  EXPECT_TRUE(result.complete);
  EXPECT_EQ(result.limit_reached, type == QueryType::LIMITED);
  return result;
}

TEST(MergeResults, KeepsAllInTheOrderOfTheirSegments) {
  const QueryResult result = merged(QueryType::ALL);
  EXPECT_EQ(join(result), (Listed{{2, 3.0}, {3, 1.0}, {4, 1.5}, {5, 2.0}}));
  EXPECT_EQ(result.others_lower, 8.0);
}

TEST(MergeResults, KeepsTheClosestAndNotesWhatItLeavesOut) {
  const QueryResult closest = merged(QueryType::CLOSEST);
  EXPECT_EQ(join(closest), (Listed{{3, 1.0}}));
  EXPECT_EQ(closest.others_lower, 1.5 - 0.1);
  const QueryResult limited = merged(QueryType::LIMITED);
  EXPECT_EQ(join(limited), (Listed{{3, 1.0}, {4, 1.5}}));
  EXPECT_EQ(limited.others_lower, 2.0 - 0.1);
}

TEST(MergeResults, KeepsTheClosestOfEachPairOfFibersAndNotesWhatItLeavesOut) {
  const QueryResult result = merged(QueryType::FIBER_PAIRS);
  EXPECT_EQ(join(result), (Listed{{2, 3.0}, {3, 1.0}}));
  EXPECT_EQ(result.others_lower, 1.5 - 0.1);
}

TEST(MergeResults, IsCompleteIfBothAreAndAtTheLimitIfItsCountIs) {
  QueryOptions options;
  options.type = QueryType::LIMITED;
  options.max_contacts = 2;
  QueryResult result;
  result.contacts = {contact(0, 0, 1, 1.0)};
  QueryResult more;
  more.complete = false;
  merge_results(options, more, result);
  EXPECT_FALSE(result.complete);
  EXPECT_FALSE(result.limit_reached);
}

}  // namespace
}  // namespace fiber

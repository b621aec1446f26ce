// What a tolerance of the closest pairs promises.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "test/support/answers.hpp"
#include "test/support/engines_test.hpp"
#include "test/support/not_finite.hpp"

namespace fiber::test {
namespace {

using ToleranceTest = EnginesTest;

std::vector<double> sorted_distances(const QueryResult& result) {
  std::vector<double> distances;
  for (const Contact& contact : result.contacts) {
    distances.push_back(contact.distance);
  }
  std::sort(distances.begin(), distances.end());
  return distances;
}

TEST_P(ToleranceTest, NothingIsCloserByMoreThanTheTolerance) {
  for_each_assembly(3, [this](const FiberAssembly& fibers, Random& random) {
    for (const QueryType type : {QueryType::CLOSEST, QueryType::LIMITED}) {
      QueryOptions options = within(infinity, type);
      options.max_contacts = static_cast<std::uint32_t>(random.integer(1, 8));
      const QueryResult truth = brute_force(fibers, options);
      options.tolerance = random.chance(0.5) ? 0.0 : random.uniform(0.0, 0.1);
      options.relative_tolerance = random.chance(0.5) ? 0.0 : random.uniform(0.0, 1.0);
      const std::vector<double> found = sorted_distances(ask(fibers, options));
      const std::vector<double> closest = sorted_distances(truth);
      ASSERT_EQ(found.size(), closest.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        const double relative = options.relative_tolerance / (1.0 + options.relative_tolerance);
        // A bound is that of the farthest reported pair.
        const double slack = std::max(options.tolerance, std::abs(found.back()) * relative);
        ASSERT_LE(found[i], closest[i] + slack * (1.0 + 1e-15) + 1e-15 * std::abs(found[i]));
      }
    }
  });
}

/// The depth that is reported is at least the greatest / (1 + ρ), and more than half of it.
TEST_P(ToleranceTest, ADepthIsWithinItsPartOfTheGreatest) {
  for_each_assembly(3, [this](const FiberAssembly& given, Random& random) {
    const double size = extent_of(given);
    const FiberAssembly fibers(given.points(), given.offsets(),
                               {std::min(0.3 * size + given.largest_radius(), 1e150)});
    for (const QueryType type : {QueryType::CLOSEST, QueryType::LIMITED, QueryType::FIBER_PAIRS}) {
      QueryOptions options = within(0.0, type);
      options.max_contacts = 3;
      const QueryResult truth = brute_force(fibers, options);
      const double part = std::exp(random.uniform(-5.0, 5.0));
      options.relative_tolerance = part;
      const QueryResult found = ask(fibers, options);
      const std::vector<double> distances = sorted_distances(found);
      const std::vector<double> closest = sorted_distances(truth);
      ASSERT_EQ(distances.size(), closest.size());
      for (std::size_t i = 0; i < distances.size() && type != QueryType::FIBER_PAIRS; ++i) {
        // The bound is that of the least depth that is reported.
        const double depth = std::abs(distances.back());
        ASSERT_GE(closest[i], distances[i] - depth * part / (1.0 + part) - 1e-15 * size);
      }
      if (type == QueryType::CLOSEST && !distances.empty() && distances[0] < 0.0) {
        ASSERT_LE(-closest[0], -distances[0] * (1.0 + part) * (1.0 + 1e-15) + 1e-15 * size);
        ASSERT_LE(-closest[0], -distances[0] * 2.0 + 1e-15 * size);
        // What is stated of the pairs that were not looked for is no less.
        ASSERT_GE(found.minimum_lower(),
                  distances[0] + distances[0] * part / (1.0 + part) - 1e-12 * size);
      }
    }
  });
}

TEST_P(ToleranceTest, EveryPairOfFibersIsWithinTheTolerance) {
  for_each_assembly(3, [this](const FiberAssembly& fibers, Random& random) {
    QueryOptions options = within(infinity, QueryType::FIBER_PAIRS);
    const QueryResult truth = brute_force(fibers, options);
    options.tolerance = random.uniform(0.0, 0.1);
    const QueryResult found = ask(fibers, options);
    ASSERT_EQ(found.contacts.size(), truth.contacts.size());
    for (const Contact& best : truth.contacts) {
      const auto same =
          std::find_if(found.contacts.begin(), found.contacts.end(), [&](const Contact& each) {
            return each.fiber_a == best.fiber_a && each.fiber_b == best.fiber_b;
          });
      ASSERT_NE(same, found.contacts.end());
      ASSERT_LE(same->distance,
                best.distance + options.tolerance + 1e-15 * std::abs(best.distance));
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Engines, ToleranceTest, engines_of_each_kind(), name_of_engine);

}  // namespace
}  // namespace fiber::test

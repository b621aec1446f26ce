// What kernels promise, and the bounds of every answer, against exact arithmetic.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "test/support/answers.hpp"
#include "test/support/contacts.hpp"
#include "test/support/engines_test.hpp"
#include "test/support/error_of.hpp"
#include "test/support/exact_pairs.hpp"
#include "test/support/not_finite.hpp"
#include "validation/geometry/hard_pairs.hpp"

namespace fiber::test {
namespace {

constexpr QueryType all_types[] = {QueryType::FIRST, QueryType::CLOSEST, QueryType::LIMITED,
                                   QueryType::ALL, QueryType::FIBER_PAIRS};
constexpr Kernel all_kernels[] = {Kernel::ROBUST, Kernel::EXACT};

using AccuracyTest = EnginesTest;

/// Margins at which some pairs only just are contacts, and some only just are not.
std::vector<double> hard_margins(const FiberAssembly& fibers, Random& random) {
  QueryOptions options = within(infinity);
  options.neighbour_skip = 1;  // as all_pairs() has it, which knows no loops
  const QueryResult result = brute_force(fibers, options);
  std::vector<double> margins{0.0};
  for (int i = 0; i < 3 && !result.contacts.empty(); ++i) {
    const int last = static_cast<int>(result.contacts.size()) - 1;
    const double gap = result.contacts[static_cast<std::size_t>(random.integer(0, last))].distance;
    for (const double margin : {std::nextafter(gap, 0.0), gap, std::nextafter(gap, infinity)}) {
      margins.push_back(std::max(margin, 0.0));
    }
  }
  return margins;
}

TEST_P(AccuracyTest, ExactDecidesExactly) {
  for_each_assembly(1, [this](const FiberAssembly& fibers, Random& random) {
    const std::vector<Pair> pairs = all_pairs(fibers);
    for (const double margin : hard_margins(fibers, random)) {
      QueryOptions options = within(margin);
      options.neighbour_skip = 1;  // as all_pairs() has it, which knows no loops
      options.kernel = Kernel::EXACT;
      const QueryResult result = ask(fibers, options);
      std::size_t count = 0;
      for (const Pair& pair : pairs) {
        const bool is_contact = pair.gap.is_at_most(margin);
        count += is_contact ? 1 : 0;
        ASSERT_EQ(find(result.contacts, pair.key) != nullptr, is_contact) << "margin " << margin;
      }
      ASSERT_EQ(result.contacts.size(), count);
    }
  });
}

TEST_P(AccuracyTest, BoundsHoldTheTruth) {
  for_each_assembly(1, [this](const FiberAssembly& fibers, Random& random) {
    const std::vector<Pair> pairs = all_pairs(fibers);
    for (const double margin : {hard_margins(fibers, random).back(), infinity}) {
      for (const QueryType type : all_types) {
        for (const Kernel kernel : all_kernels) {
          QueryOptions options = within(margin, type);
          options.neighbour_skip = 1;  // as all_pairs() has it, which knows no loops
          options.kernel = kernel;
          options.max_contacts = 5;
          options.tolerance = random.chance(0.5) ? 0.0 : 0.01;
          const QueryResult result = ask(fibers, options);
          ASSERT_TRUE(result.complete);
          const double minimum_lower = result.minimum_lower();
          for (const Pair& pair : pairs) {
            const Contact* contact = find(result.contacts, pair.key);
            const double lower = contact != nullptr ? contact->lower : result.others_lower;
            ASSERT_TRUE(pair.gap.is_at_least(lower)) << name_of(kernel);
            if (!(minimum_lower <= lower)) {  // otherwise that is said already
              ASSERT_TRUE(pair.gap.is_at_least(minimum_lower)) << name_of(kernel);
            }
            if (contact != nullptr) {
              ASSERT_TRUE(pair.gap.is_at_most(contact->upper)) << name_of(kernel);
              ASSERT_LE(contact->lower, contact->distance);
              ASSERT_LE(contact->distance, contact->upper);
            }
          }
        }
      }
    }
  });
}

TEST_P(AccuracyTest, EngineAndBruteForceAgreeWithEveryKernel) {
  for_each_assembly(1, [this](const FiberAssembly& fibers, Random& random) {
    for (const double margin : {hard_margins(fibers, random).back(), infinity}) {
      for (const QueryType type :
           {QueryType::CLOSEST, QueryType::LIMITED, QueryType::ALL, QueryType::FIBER_PAIRS}) {
        for (const Kernel kernel : all_kernels) {
          QueryOptions options = within(margin, type);
          options.kernel = kernel;
          options.max_contacts = 5;
          const QueryResult expected = brute_force(fibers, options);
          ASSERT_TRUE(same_contacts(ask(fibers, options).contacts, expected.contacts))
              << name_of(kernel) << ", type " << static_cast<int>(type);
        }
      }
    }
  });
}

/// Two capsules that touch but for a few units in the last place: the kernel ROBUST takes some for
/// no contact that are one.
TEST_P(AccuracyTest, BoundsOfWhatIsLeftOutHoldTheTruth) {
  SCOPED_TRACE(seed_message());
  const std::unique_ptr<ProximityEngine> engine = make_engine(GetParam());
  QueryResult result;
  for (const HardFamily& family : hard_families()) {
    for (const HardPair& pair : hard_pairs(family, 20, run_seed())) {
      const FiberAssembly fibers({pair.p0, pair.p1, pair.q0, pair.q1}, {0, 2, 4},
                                 {pair.radius_a, pair.radius_b});
      engine->update(fibers);
      for (const QueryType type : all_types) {
        engine->query(within(0.0, type), result);
        ASSERT_TRUE(all_pairs(fibers).front().gap.is_at_least(result.minimum_lower()))
            << family.name << ", type " << static_cast<int>(type);
      }
    }
  }
}

/// The same of pairs that are as close as one another but for the last digits.
TEST_P(AccuracyTest, BoundsOfAllButTheClosestHoldTheTruth) {
  SCOPED_TRACE(seed_message());
  const std::unique_ptr<ProximityEngine> engine = make_engine(GetParam());
  const QueryOptions options = within(infinity, QueryType::CLOSEST);
  QueryResult result;
  for (const HardFamily& family : hard_families()) {
    for (const HardPair& pair : hard_pairs(family, 20, run_seed())) {
      Eigen::Vector3d moved = pair.q1;
      moved.x() = std::nextafter(moved.x(), 0.0);
      for (const bool moved_first : {false, true}) {
        const Eigen::Vector3d& first = moved_first ? moved : pair.q1;
        const Eigen::Vector3d& second = moved_first ? pair.q1 : moved;
        const FiberAssembly fibers({pair.q0, first, pair.q0, second}, {0, 2, 4}, {0.0});
        engine->update(fibers);
        engine->query_shape(FiberAssembly({pair.p0, pair.p1}, {0, 2}, {0.0}), options, result);
        ASSERT_EQ(result.contacts.size(), 1U);
        for (const std::uint32_t fiber : {0U, 1U}) {
          const Contact& contact = result.contacts.front();
          const double lower = contact.fiber_b == fiber ? contact.lower : result.others_lower;
          const Gap gap({pair.p0, pair.p1, 0.0}, fibers.capsule(2 * fiber));
          ASSERT_TRUE(gap.is_at_least(lower)) << family.name;
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Engines, AccuracyTest, engines_of_each_kind(), name_of_engine);

TEST(QueryOptions, RefuseWhatIsNoAccuracy) {
  const double bad[] = {-1.0, infinity, std::nan("")};
  using Field = std::pair<double QueryOptions::*, const char*>;
  for (const auto& [field, name] : {Field{&QueryOptions::tolerance, "tolerance"},
                                    Field{&QueryOptions::relative_tolerance, "relative_tolerance"},
                                    Field{&QueryOptions::deadline, "deadline"}}) {
    for (const double value : bad) {
      QueryOptions options;
      options.*field = value;
      const std::string error = error_of([&] { validate(options); });
      EXPECT_EQ(error.rfind(std::string(name) + " is ", 0), 0U) << error << ", of " << value;
    }
  }
}

}  // namespace
}  // namespace fiber::test

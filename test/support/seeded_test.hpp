#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "test/support/random.hpp"

namespace fiber::test {

/// Tests that go with the seed of the run, and with those that once found something:
/// INSTANTIATE_TEST_SUITE_P(Seeds, SomeTest, run_seed_and({17}), name_of_seed).
class SeededTest : public testing::TestWithParam<std::uint64_t> {
 public:
  static constexpr std::uint64_t of_the_run = 0;

 protected:
  static std::uint64_t seed() { return GetParam() == of_the_run ? run_seed() : GetParam(); }
};

inline auto run_seed_and(std::vector<std::uint64_t> once_failed) {
  once_failed.insert(once_failed.begin(), SeededTest::of_the_run);
  return testing::ValuesIn(once_failed);
}

inline std::string name_of_seed(const testing::TestParamInfo<std::uint64_t>& seed) {
  return seed.param == SeededTest::of_the_run ? "OfTheRun" : std::to_string(seed.param);
}

}  // namespace fiber::test

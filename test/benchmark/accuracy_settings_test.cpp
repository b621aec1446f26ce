#include "benchmark/accuracy_settings.hpp"

#include <gtest/gtest.h>

#include <string>

namespace fiber::test {
namespace {

TEST(AccuracySettings, EachQueryBeginsWithItsReference) {
  std::string query;
  for (const AccuracySetting& setting : accuracy_settings(0.01)) {
    EXPECT_EQ(setting.is_reference, setting.query != query) << setting.name;
    query = setting.query;
    EXPECT_NO_THROW(validate(setting.options));
    EXPECT_EQ(setting.options.deadline, 0.0);
  }
}

}  // namespace
}  // namespace fiber::test

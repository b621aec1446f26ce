#include "src/io/number.hpp"

#include <gtest/gtest.h>

#include <clocale>
#include <cmath>
#include <cstring>
#include <limits>

#include "test/support/random.hpp"

namespace fiber::test {
namespace {

TEST(ParseDecimalOrHex, ReadsBoth) {
  EXPECT_EQ(parse_decimal_or_hex("-2.5e-1"), -0.25);
  EXPECT_EQ(parse_decimal_or_hex("+3"), 3.0);
  EXPECT_EQ(parse_decimal_or_hex("0x1.8p+1"), 3.0);
  EXPECT_EQ(parse_decimal_or_hex("-0X.8P-1"), -0.25);
  EXPECT_EQ(parse_decimal_or_hex("+0xA"), 10.0);
  EXPECT_EQ(parse_decimal_or_hex("0x1p-1074"), 5e-324);
  EXPECT_EQ(parse_decimal_or_hex("0x1.fffffffffffffp+1023"), 1.7976931348623157e308);
}

TEST(ParseDecimalOrHex, RefusesWhatIsNoNumber) {
  for (const char* text : {"", "-", "+", "0x", "-0x", "0x-1", "0x+1", "--0x1", "0xnan", "0x1p",
                           "x1", "0x1 ", " 0x1", "1p3", "0x1p+5000", "1e400"}) {
    EXPECT_EQ(parse_decimal_or_hex(text), std::nullopt) << text;
  }
}

std::string text_of(double value) {
  std::string text;
  append_double(text, value);
  return text;
}

std::string text_by_c_library(double value) {
  std::string text;
  by_c_library::append_double(text, value);
  return text;
}

double any_double(Random& random) {
  const auto bits = static_cast<std::uint64_t>(random.uniform(0.0, 0x1p32)) << 32U |
                    static_cast<std::uint64_t>(random.uniform(0.0, 0x1p32));
  double value = 0.0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

TEST(DoubleByTheCLibrary, IsWrittenAsByTheStandardLibrary) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  std::vector<double> values{0.0,
                             -0.0,
                             1.0,
                             0.1,
                             0.0001,
                             1e-5,
                             1e5,
                             1e22,
                             1.2e6,
                             123456.,
                             1e300,
                             5e-324,
                             0.1 + 0.2,
                             -1.5e-7,
                             1e21,
                             1.2e20,
                             std::numeric_limits<double>::infinity()};
  for (int i = 0; i < 3000; ++i) {
    const double value = any_double(random);
    values.push_back(std::isnan(value) ? 0.5 : value);
    values.push_back(std::round(random.uniform(-1e4, 1e4)) * std::pow(10.0, random.integer(-9, 9)));
  }
  for (const double value : values) {
    ASSERT_EQ(text_by_c_library(value), text_of(value));
  }
}

TEST(DoubleByTheCLibrary, IsReadAsByTheStandardLibrary) {
  SCOPED_TRACE(seed_message());
  Random random(2);
  for (const bool is_hex : {false, true}) {
    for (const char* text :
         {"",        "-",       "+1",   "--1",      " 1",    "1 ",     "1",      "-1",     "1.",
          ".5",      ".",       "1e",   "1e5",      "1e400", "-1e400", "1e-400", "1e-310", "0x1",
          "0X1",     "inf",     "-inf", "infinity", "nan",   "-nan",   "1,5",    "1.8p+1", "fp2",
          "1p-1080", "1p-1074", "abc",  "x",        "\t1",   "1\n"}) {
      if (is_hex && std::strpbrk(text, "in") != nullptr) {
        continue;  // names: callers have refused them
      }
      EXPECT_EQ(text_of(by_c_library::parse_double(text, is_hex).value_or(12345.0)),
                text_of(parse_double(text, is_hex).value_or(12345.0)))
          << text << (is_hex ? ", hexadecimal" : "");
    }
  }
  for (int i = 0; i < 3000; ++i) {
    const std::string text = text_of(any_double(random));
    EXPECT_EQ(by_c_library::parse_double(text, false).has_value(),
              parse_double(text, false).has_value());
    EXPECT_EQ(text_of(by_c_library::parse_double(text, false).value_or(0.0)),
              text_of(parse_double(text, false).value_or(0.0)));
  }
}

/// In one with commas, if such a one is installed.
TEST(DoubleByTheCLibrary, HasPointsInAnyLocale) {
  for (const char* const name : {"de_DE.UTF-8", "fr_FR.UTF-8"}) {
    std::setlocale(LC_ALL, name);
  }
  EXPECT_EQ(text_by_c_library(1.5), "1.5");
  EXPECT_EQ(by_c_library::parse_double("1.5", false), 1.5);
  EXPECT_EQ(by_c_library::parse_double("1,5", false), std::nullopt);
  std::setlocale(LC_ALL, "C");
}

}  // namespace
}  // namespace fiber::test

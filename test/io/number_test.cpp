#include "src/io/number.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace fiber::test

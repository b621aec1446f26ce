#include "src/text/quote.hpp"

#include <gtest/gtest.h>

namespace fiber::test {
namespace {

TEST(Quote, LeavesPrintableTextsAsTheyAre) {
  for (const std::string text :
       {"", "x", "a b'c\"\\", "Litze Nr. 5 \u2013 \u00e4\u00f6\u00fc \u7d72 \U0001F9F5"}) {
    EXPECT_EQ(quote(text), "'" + text + "'");
  }
}

TEST(Quote, EscapesControlCharactersAndWhatIsNotUtf8) {
  using namespace std::string_view_literals;
  EXPECT_EQ(quote("a\nb\rc\td"), "'a\\nb\\rc\\td'");
  EXPECT_EQ(quote("\0\x01\x1B[2J\x7F"sv), "'\\x00\\x01\\x1B[2J\\x7F'");
  EXPECT_EQ(quote("\xC2\x9B"
                  "31m"),
            "'\\xC2\\x9B31m'")
      << "C1 controls are terminals' too";
  EXPECT_EQ(quote("\xFF\xC3"), "'\\xFF\\xC3'");
  EXPECT_EQ(quote("\xC0\xAF\xE0\x80\xAF\xF0\x80\x80\xAF"),
            "'\\xC0\\xAF\\xE0\\x80\\xAF\\xF0\\x80\\x80\\xAF'");
  EXPECT_EQ(quote("\xE2\x80"), "'\\xE2\\x80'");
}

TEST(Quote, EveryByteGivesOnePrintableLine) {
  for (int byte = 0; byte < 256; ++byte) {
    for (const char letter : shortened(std::string(3, static_cast<char>(byte)))) {
      EXPECT_TRUE(letter >= ' ' && letter <= '~') << byte;
    }
  }
}

TEST(Quote, KeepsBeginningAndEndOfLongTexts) {
  // So long on purpose. NOLINTNEXTLINE(bugprone-string-constructor)
  const std::string text = "begin" + std::string(50'000'000, 'x') + "end";
  const std::string line = shortened(text);
  EXPECT_EQ(line.substr(0, 6), "beginx");
  EXPECT_EQ(line.substr(line.size() - 4), "xend");
  EXPECT_NE(line.find("... (49999808 more bytes) ..."), std::string::npos) << line;
  EXPECT_LE(line.size(), 240U);
  EXPECT_EQ(shortened(std::string(200, 'x')), std::string(200, 'x'));
  EXPECT_LE(shortened(std::string(1000, '\n'), 100).size(), 250U);
}

TEST(Quote, CutsBetweenCharacters) {
  for (std::size_t offset = 0; offset < 4; ++offset) {
    std::string text(offset, 'a');
    for (int i = 0; i < 100; ++i) {
      text += "\U0001F9F5";
    }
    EXPECT_EQ(shortened(text).find("\\x"), std::string::npos) << shortened(text);
  }
}

}  // namespace
}  // namespace fiber::test

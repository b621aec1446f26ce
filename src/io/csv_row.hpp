#pragma once

#include <deque>
#include <string>
#include <string_view>
#include <vector>

namespace fiber {

constexpr std::string_view blanks = " \t\r";

inline bool is_blank(char letter) { return letter == ' ' || letter == '\t' || letter == '\r'; }

/// Without the blanks around it.
inline std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) {
    text.remove_prefix(1);
  }
  while (!text.empty() && is_blank(text.back())) {
    text.remove_suffix(1);
  }
  return text;
}

/// The separator of the values of a line: one of these letters, a blank for any number of blanks.
constexpr std::string_view separators = ",;\t ";

/// Values of a line of CSV (RFC 4180): without the blanks around them, or quoted, whatever is in
/// them but a line's end.
class CsvRow {
 public:
  /// Takes a line apart, which stays where it is.
  /// @return nullptr, or what is wrong with the value after those that there are now
  const char* split(std::string_view line, char separator);

  const std::vector<std::string_view>& fields() const { return fields_; }

 private:
  const char* take_quoted(std::string_view& line);
  const char* split_at_blanks(std::string_view line);

  std::vector<std::string_view> fields_;
  std::deque<std::string> unquoted_;  // those with quotes in them
};

}  // namespace fiber

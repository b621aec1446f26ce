#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace fiber {

/// Appends a number as the shortest decimal that reads back as the same value, in any locale.
template <class Number>
void append_number(std::string& text, Number value) {
  char buffer[32];  // the longest double takes 24 characters
  const std::to_chars_result end = std::to_chars(buffer, buffer + sizeof(buffer), value);
  text.append(buffer, end.ptr);
}

/// The number a whole text stands for, in any locale; a leading plus is allowed. Nothing if it is
/// no number or lies outside the type's range.
template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') {
    text.remove_prefix(1);
  }
  Number value{};
  const char* end = text.data() + text.size();
  const std::from_chars_result result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end) {
    return std::nullopt;
  }
  return value;
}

}  // namespace fiber

#pragma once

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <type_traits>

#include "fiber_proximity/export.hpp"

namespace fiber {

/// Appends the shortest decimal that reads back as the same value, in any locale: fixed where that
/// takes no more characters than scientific notation.
FIBER_PROXIMITY_EXPORT void append_double(std::string& text, double value);

/// The double that a whole text stands for, in any locale: decimal, or of hexadecimal digits
/// without 0x. Without a plus sign or blanks. Nothing if it is no number or lies outside the range.
FIBER_PROXIMITY_EXPORT std::optional<double> parse_double(std::string_view text, bool is_hex);

/// Both functions by the C library: for a standard library that has them for integers only, as that
/// of GCC 9 and 10.
namespace by_c_library {
FIBER_PROXIMITY_EXPORT void append_double(std::string& text, double value);
FIBER_PROXIMITY_EXPORT std::optional<double> parse_double(std::string_view text, bool is_hex);
}  // namespace by_c_library

/// Appends a number as the shortest decimal that reads back as the same value, in any locale.
template <class Number>
void append_number(std::string& text, Number value) {
  if constexpr (std::is_same_v<Number, double>) {
    append_double(text, value);
  } else {
    static_assert(std::is_integral_v<Number>);
    char buffer[24];  // the longest integer takes 20 characters
    const std::to_chars_result end = std::to_chars(buffer, buffer + sizeof(buffer), value);
    text.append(buffer, end.ptr);
  }
}

template <class Number>
std::string text_of(Number value) {
  std::string text;
  append_number(text, value);
  return text;
}

/// The number a whole text stands for, in any locale; a leading plus is allowed. Nothing if it is
/// no number or lies outside the type's range.
template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') {
    text.remove_prefix(1);
  }
  if constexpr (std::is_same_v<Number, double>) {
    return parse_double(text, false);
  } else {
    static_assert(std::is_integral_v<Number>);
    Number value{};
    const char* end = text.data() + text.size();
    const std::from_chars_result result = std::from_chars(text.data(), end, value);
    if (result.ec != std::errc() || result.ptr != end) {
      return std::nullopt;
    }
    return value;
  }
}

/// Parses a decimal number or a C hexadecimal one, such as -0x1.8p-3.
inline std::optional<double> parse_decimal_or_hex(std::string_view text) {
  const bool signs = !text.empty() && (text[0] == '-' || text[0] == '+');
  std::string_view digits = text.substr(signs ? 1 : 0);
  if (digits.substr(0, 2) != "0x" && digits.substr(0, 2) != "0X") {
    return parse_number<double>(text);
  }
  digits.remove_prefix(2);
  if (digits.find_first_not_of("0123456789abcdefABCDEF.") == 0) {
    return std::nullopt;  // neither another sign nor a name like nan
  }
  const std::optional<double> value = parse_double(digits, true);
  return value && text[0] == '-' ? -*value : value;
}

}  // namespace fiber

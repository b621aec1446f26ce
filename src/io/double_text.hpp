#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fiber {

/// Appends the shortest decimal that reads back as the same value, in any locale: fixed where that
/// takes no more characters than scientific notation.
void append_double(std::string& text, double value);

/// The double that a whole text stands for, in any locale: decimal, or of hexadecimal digits
/// without 0x. Without a plus sign or blanks. Nothing if it is no number or lies outside the range.
std::optional<double> parse_double(std::string_view text, bool is_hex);

/// The same two by the C library: for a standard library that has them for integers only, as that
/// of GCC 9 and 10.
namespace by_c_library {
void append_double(std::string& text, double value);
std::optional<double> parse_double(std::string_view text, bool is_hex);
}  // namespace by_c_library

}  // namespace fiber

#include "src/io/number.hpp"

#include <locale.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <system_error>

namespace fiber {

namespace by_c_library {
namespace {

/// The numbers of the C locale for one thread, while this lives.
class NumbersOfC {
 public:
  NumbersOfC() : before_(uselocale(locale())) {}
  ~NumbersOfC() { uselocale(before_); }
  NumbersOfC(const NumbersOfC&) = delete;
  NumbersOfC& operator=(const NumbersOfC&) = delete;

 private:
  static locale_t locale() {
    static const locale_t of_c = newlocale(LC_NUMERIC_MASK, "C", nullptr);
    return of_c;
  }

  locale_t before_;
};

std::string formatted(const char* format, int digits, double value) {
  std::string text(400, '\0');  // 1e308 has 309 digits
  text.resize(
      static_cast<std::size_t>(std::snprintf(text.data(), text.size(), format, digits, value)));
  return text;
}

}  // namespace

void append_double(std::string& text, double value) {
  const NumbersOfC numbers;
  if (!std::isfinite(value)) {
    text += formatted("%.*f", 0, value);
    return;
  }
  std::string scientific;
  int after_point = -1;
  do {
    scientific = formatted("%.*e", ++after_point, value);
  } while (std::strtod(scientific.c_str(), nullptr) != value);
  const int exponent = std::atoi(scientific.c_str() + scientific.find('e') + 1);
  const std::string fixed = formatted("%.*f", std::max(0, after_point - exponent), value);
  text += fixed.size() <= scientific.size() ? fixed : scientific;
}

std::optional<double> parse_double(std::string_view text, bool is_hex) {
  const NumbersOfC numbers;
  const std::size_t sign = !text.empty() && text[0] == '-' ? 1 : 0;
  std::string number(text.substr(sign));
  // strtod reads more than what is a number here: signs, blanks, 0x.
  if (number.empty() || number.find_first_of("+- \t\n\v\f\r") == 0 ||
      (number.size() > 1 && (number[1] == 'x' || number[1] == 'X'))) {
    return std::nullopt;
  }
  number.insert(0, is_hex ? "0x" : "");
  char* end = nullptr;
  errno = 0;
  const double value = std::strtod(number.c_str(), &end);
  // Subnormal numbers are in range.
  const bool is_out_of_range = errno == ERANGE && (value == 0.0 || std::isinf(value));
  if (end != number.c_str() + number.size() || is_out_of_range) {
    return std::nullopt;
  }
  return sign == 1 ? -value : value;
}

}  // namespace by_c_library

#ifdef __cpp_lib_to_chars

void append_double(std::string& text, double value) {
  char buffer[32];  // the longest double takes 24 characters
  const std::to_chars_result end = std::to_chars(buffer, buffer + sizeof(buffer), value);
  text.append(buffer, end.ptr);
}

std::optional<double> parse_double(std::string_view text, bool is_hex) {
  double value = 0.0;
  const char* end = text.data() + text.size();
  const std::from_chars_result result = std::from_chars(
      text.data(), end, value, is_hex ? std::chars_format::hex : std::chars_format::general);
  if (result.ec != std::errc() || result.ptr != end) {
    return std::nullopt;
  }
  return value;
}

#else

void append_double(std::string& text, double value) { by_c_library::append_double(text, value); }

std::optional<double> parse_double(std::string_view text, bool is_hex) {
  return by_c_library::parse_double(text, is_hex);
}

#endif

}  // namespace fiber

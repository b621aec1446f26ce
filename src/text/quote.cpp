#include "src/text/quote.hpp"

namespace fiber {
namespace {

bool is_continuation(char byte) { return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U; }

/// The bytes of the printable character that a text begins with; 0 if it begins with none. What
/// stands beyond ASCII is taken by its form: no overlong ones, no C1 controls (U+0080 to U+009F).
std::size_t printable_length(std::string_view text) {
  const auto first = static_cast<unsigned char>(text[0]);
  if (first < 0x80U) {
    return first >= 0x20U && first != 0x7FU ? 1 : 0;
  }
  const std::size_t length = first < 0xC2U   ? 0
                             : first < 0xE0U ? 2
                             : first < 0xF0U ? 3
                             : first < 0xF5U ? 4
                                             : 0;
  if (text.size() < length) {
    return 0;
  }
  for (std::size_t i = 1; i < length; ++i) {
    if (!is_continuation(text[i])) {
      return 0;
    }
  }
  const unsigned second = length == 0 ? 0U : static_cast<unsigned char>(text[1]);
  const bool is_control = first == 0xC2U && second < 0xA0U;
  const bool is_overlong = (first == 0xE0U && second < 0xA0U) || (first == 0xF0U && second < 0x90U);
  return is_control || is_overlong ? 0 : length;
}

void append_escaped(std::string& line, char byte) {
  const std::size_t named = std::string_view("\n\r\t").find(byte);
  if (named != std::string_view::npos) {
    line += '\\';
    line += "nrt"[named];
    return;
  }
  constexpr char digits[] = "0123456789ABCDEF";
  const auto value = static_cast<unsigned char>(byte);
  line += "\\x";
  line += digits[value / 16];
  line += digits[value % 16];
}

void append_printable(std::string& line, std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = printable_length(text);
    if (length == 0) {
      append_escaped(line, text.front());
      text.remove_prefix(1);
    } else {
      line += text.substr(0, length);
      text.remove_prefix(length);
    }
  }
}

/// Where the character that holds this byte begins, if it begins close before it.
std::size_t character_start(std::string_view text, std::size_t place) {
  constexpr std::size_t longest = 4;
  for (std::size_t back = 0; back < longest && back <= place; ++back) {
    if (!is_continuation(text[place - back])) {
      return place - back;
    }
  }
  return place;
}

}  // namespace

std::string shortened(std::string_view text, std::size_t most) {
  std::string line;
  if (text.size() <= most) {
    append_printable(line, text);
    return line;
  }
  const std::size_t head = character_start(text, most - most / 4);
  const std::size_t tail = character_start(text, text.size() - most / 4);
  append_printable(line, text.substr(0, head));
  line += "... (" + std::to_string(tail - head) + " more bytes) ...";
  append_printable(line, text.substr(tail));
  return line;
}

std::string quote(std::string_view text) { return "'" + shortened(text) + "'"; }

}  // namespace fiber

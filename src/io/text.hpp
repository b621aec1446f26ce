#pragma once

#include <string_view>
#include <vector>

namespace fiber {

constexpr std::string_view blanks = " \t\r";

/// Without the blanks around it.
inline std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) {
    return {};
  }
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

/// The fields of a line between commas, trimmed.
inline void split(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  std::size_t comma = line.find(',');
  while (comma != std::string_view::npos) {
    fields.push_back(trimmed(line.substr(0, comma)));
    line.remove_prefix(comma + 1);
    comma = line.find(',');
  }
  fields.push_back(trimmed(line));
}

}  // namespace fiber

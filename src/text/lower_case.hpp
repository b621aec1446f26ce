#pragma once

#include <string>
#include <string_view>

namespace fiber {

/// A text with small letters for the capitals A to Z, whatever the locale.
inline std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& letter : lower) {
    letter = letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  }
  return lower;
}

}  // namespace fiber

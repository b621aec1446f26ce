#include "src/text/csv_field.hpp"

namespace fiber {
namespace {

bool needs_quotes(std::string_view text) {
  constexpr std::string_view blanks_of_fields = " \t";
  return text.empty() || text.find_first_of(",\"\r\n") != std::string_view::npos ||
         text.front() == '#' || blanks_of_fields.find(text.front()) != std::string_view::npos ||
         blanks_of_fields.find(text.back()) != std::string_view::npos;
}

}  // namespace

void append_csv_field(std::string& line, std::string_view text) {
  if (!needs_quotes(text)) {
    line += text;
    return;
  }
  line += '"';
  for (const char letter : text) {
    line += letter;
    if (letter == '"') {
      line += '"';
    }
  }
  line += '"';
}

}  // namespace fiber

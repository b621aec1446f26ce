#include "src/io/csv_row.hpp"

namespace fiber {
namespace {

constexpr const char* not_closed = "has no closing quote on its line";
constexpr const char* goes_on = "goes on after its closing quote";

}  // namespace

const char* CsvRow::split(std::string_view line, char separator) {
  fields_.clear();
  unquoted_.clear();
  if (separator == ' ') {
    return split_at_blanks(trimmed(line));
  }
  while (true) {
    std::size_t end = line.find(separator);
    std::string_view field = trimmed(line.substr(0, end));
    if (!field.empty() && field.front() == '"') {
      line.remove_prefix(static_cast<std::size_t>(field.data() - line.data()));
      if (const char* const problem = take_quoted(line)) {
        return problem;
      }
      end = line.find(separator);
      if (!trimmed(line.substr(0, end)).empty()) {
        fields_.pop_back();
        return goes_on;
      }
    } else {
      fields_.push_back(field);
    }
    if (end == std::string_view::npos) {
      return nullptr;
    }
    line.remove_prefix(end + 1);
  }
}

/// Takes the value off a line that begins with its quote.
const char* CsvRow::take_quoted(std::string_view& line) {
  std::size_t end = line.find('"', 1);
  bool has_quotes = false;
  while (end != std::string_view::npos && end + 1 < line.size() && line[end + 1] == '"') {
    has_quotes = true;
    end = line.find('"', end + 2);
  }
  if (end == std::string_view::npos) {
    return not_closed;
  }
  std::string_view value = line.substr(1, end - 1);
  if (has_quotes) {
    std::string& text = unquoted_.emplace_back();
    for (std::size_t i = 0; i < value.size(); ++i) {
      text += value[i];
      i += value[i] == '"' ? 1 : 0;
    }
    value = text;
  }
  fields_.push_back(value);
  line.remove_prefix(end + 1);
  return nullptr;
}

const char* CsvRow::split_at_blanks(std::string_view line) {
  while (!line.empty()) {
    if (line.front() == '"') {
      if (const char* const problem = take_quoted(line)) {
        return problem;
      }
      if (!line.empty() && !is_blank(line.front())) {
        fields_.pop_back();
        return goes_on;
      }
    } else {
      fields_.push_back(line.substr(0, line.find_first_of(blanks)));
      line.remove_prefix(fields_.back().size());
    }
    line = trimmed(line);
  }
  return nullptr;
}

}  // namespace fiber

#include "src/io/coordinate_rows.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/io/number.hpp"
#include "src/io/text.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

bool is_number(std::string_view text) { return parse_decimal_or_hex(text).has_value(); }

std::string_view first_part(std::string_view field) {
  return field.substr(0, field.find_first_of(blanks));
}

/// Appends the parts between blanks; nothing between commas is an empty field.
void append_parts(std::string_view field, std::vector<std::string_view>& parts) {
  do {
    parts.push_back(first_part(field));
    field = trimmed(field.substr(parts.back().size()));
  } while (!field.empty());
}

}  // namespace

CoordinateRows::CoordinateRows(std::istream& stream, std::string name, RowFormat format)
    : lines_(stream, name),
      name_(std::move(name)),
      format_(std::move(format)),
      coordinates_(format_.coordinates.size()) {}

bool CoordinateRows::next() {
  bool found = next_fields();
  if (std::exchange(is_first_, false) && found && is_header()) {
    found = next_fields();
  }
  if (found) {
    read_coordinates();
  }
  return found;
}

bool CoordinateRows::next_fields() {
  for (std::string_view line; lines_.next(line);) {
    ++line_;
    line = trimmed(line);
    if (!line.empty()) {
      split_row(line);
      check_fields(fields_, name_, line_);
      return true;
    }
  }
  return false;
}

void CoordinateRows::split_row(std::string_view row) {
  split(row, between_commas_);
  const bool has_names = !format_.may_lack_names || !is_number(first_part(between_commas_.front()));
  name_count_ = has_names ? format_.names.size() : 0;
  const bool has_commas = between_commas_.size() > 1;
  fields_.clear();
  for (std::size_t i = 0; i < between_commas_.size(); ++i) {
    if (has_commas && i < name_count_) {
      fields_.push_back(between_commas_[i]);
    } else {
      append_parts(between_commas_[i], fields_);
    }
  }
}

bool CoordinateRows::is_header() const {
  return fields_.size() >= format_.coordinates.size() &&
         std::none_of(fields_.begin(), fields_.end(), is_number);
}

void CoordinateRows::read_coordinates() {
  const std::size_t expected = name_count_ + coordinates_.size();
  if (fields_.size() < expected || (fields_.size() > expected && !format_.ignores_more)) {
    refuse_field_count();
  }
  for (std::size_t i = 0; i < coordinates_.size(); ++i) {
    coordinates_[i] = read_coordinate(name_count_ + i, format_.coordinates[i]);
  }
}

double CoordinateRows::read_coordinate(std::size_t field, const char* column) const {
  const std::optional<double> value = parse_decimal_or_hex(fields_[field]);
  if (!value || !FiberAssembly::is_valid_coordinate(*value)) {
    throw FileError(name_, line_,
                    "column " + std::to_string(field + 1) + " (" + column + ") is " +
                        quote(fields_[field]) + ", " +
                        (value ? FiberAssembly::coordinate_rule : "expected a number"));
  }
  return *value;
}

void CoordinateRows::refuse_field_count() const {
  const std::size_t names = std::min(name_count_, fields_.size());
  std::string reason = "has " + std::to_string(fields_.size() - names) + " values";
  for (std::size_t i = 0; i < names; ++i) {
    reason +=
        (i == 0 ? " after " : " and ") + std::string(format_.names[i]) + ' ' + quote(fields_[i]);
  }
  throw FileError(name_, line_, reason + ", expected " + format_.all_coordinates);
}

}  // namespace fiber

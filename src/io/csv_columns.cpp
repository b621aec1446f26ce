#include "src/io/csv_columns.hpp"

#include "src/io/csv_row.hpp"
#include "src/text/lower_case.hpp"

namespace fiber {
namespace {

/// @return COLUMNS for what means nothing here
CsvColumns::Column column_called(const std::string& name) {
  constexpr std::array<std::string_view, CsvColumns::COLUMNS> names{
      "frame", "fiber", "x", "y", "z", "radius", "closed", "joint"};
  std::size_t column = 0;
  while (column < names.size() && names[column] != name) {
    ++column;
  }
  return name == "fibre" ? CsvColumns::FIBER : static_cast<CsvColumns::Column>(column);
}

CsvColumns columns_of(const std::vector<std::string_view>& names, char separator) {
  CsvColumns columns;
  columns.separator = separator;
  columns.count = names.size();
  columns.places.fill(CsvColumns::none);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::string name = lower_case(trimmed(names[i]));
    const CsvColumns::Column column = column_called(name);
    if (column == CsvColumns::COLUMNS) {
      if (!name.empty()) {
        columns.others.emplace_back(trimmed(names[i]));
      }
    } else if (columns.has(column)) {
      columns.twice = name;
    } else {
      columns.places[column] = i;
    }
  }
  return columns;
}

}  // namespace

std::optional<CsvColumns> columns_in(std::string_view header) {
  CsvRow row;
  for (const char separator : separators) {
    if (row.split(header, separator) == nullptr) {
      CsvColumns columns = columns_of(row.fields(), separator);
      if (columns.has(CsvColumns::X) && columns.has(CsvColumns::Y) && columns.has(CsvColumns::Z)) {
        return columns;
      }
    }
  }
  return std::nullopt;
}

}  // namespace fiber

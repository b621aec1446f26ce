#include "benchmark/report.hpp"

#include <algorithm>
#include <iomanip>
#include <iostream>

namespace fiber {
namespace {

/// Begins a cell: texts stand at its left, numbers at its right.
std::ostream& begin_cell(const TableColumn& column, const BenchmarkRow& row) {
  constexpr int text_width = 28;
  constexpr int number_width = 18;
  const auto heading = static_cast<int>(column.heading.size());
  const bool is_text = row.at(column.field).is_string();
  return std::cout << (is_text ? std::left : std::right)
                   << std::setw(std::max(heading + 2, is_text ? text_width : number_width));
}

void print_value(std::ostream& stream, const BenchmarkRow& value, double factor) {
  if (value.is_string()) {
    stream << value.get<std::string>();
  } else if (value.is_null()) {
    stream << '-';
  } else {
    stream << factor * value.get<double>();
  }
}

}  // namespace

void RowPrinter::print(const BenchmarkRow& row) {
  if (json_) {
    std::cout << row.dump() << std::endl;
    return;
  }
  if (!has_heading_) {
    has_heading_ = true;
    for (const TableColumn& column : columns_) {
      begin_cell(column, row) << column.heading;
    }
    std::cout << '\n';
  }
  for (const TableColumn& column : columns_) {
    print_value(begin_cell(column, row), row.at(column.field), column.factor);
  }
  std::cout << std::endl;
}

void print_fields(const BenchmarkRow& row, bool json) {
  if (json) {
    std::cout << row.dump() << '\n';
    return;
  }
  for (const auto& [name, value] : row.items()) {
    std::cout << name << ' ' << value << '\n';
  }
}

}  // namespace fiber

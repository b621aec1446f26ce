#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fiber {

/// A line of results: names and values.
using BenchmarkRow = nlohmann::ordered_json;
using ReportRow = std::function<void(const BenchmarkRow&)>;

/// A column of a table: its heading, the field of the rows that it shows, and what numbers are
/// multiplied with for the unit of the heading.
struct TableColumn {
  TableColumn(const char* field_name) : heading(field_name), field(field_name) {}
  TableColumn(const char* text, const char* field_name, double unit_factor = 1.0)
      : heading(text), field(field_name), factor(unit_factor) {}

  std::string heading;
  std::string field;
  double factor = 1.0;
};

/// Prints rows as they come: as JSON Lines, or as a table whose heading comes before the first row.
class RowPrinter {
 public:
  RowPrinter(std::vector<TableColumn> columns, bool json)
      : columns_(std::move(columns)), json_(json) {}

  void print(const BenchmarkRow& row);

 private:
  const std::vector<TableColumn> columns_;
  const bool json_;
  bool has_heading_ = false;
};

/// Prints the fields of one row, a line for each, or as JSON.
void print_fields(const BenchmarkRow& row, bool json);

}  // namespace fiber

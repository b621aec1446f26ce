#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "src/io/input_file.hpp"

namespace fiber {

/// What a row of a file of points is made of.
struct RowFormat {
  /// Columns before the coordinates, as errors call them.
  std::vector<const char*> names;

  /// Whether a row that begins with a number has no names.
  bool may_lack_names = false;

  /// Those of the coordinates, of which there are three for each point.
  std::vector<const char*> coordinates;

  /// Whether further columns are ignored, or refused.
  bool ignores_more = false;

  /// How an error calls all coordinates together.
  const char* all_coordinates = "";
};

/// Reads a file of points row by row. Fields are separated by commas, blanks or both; where there
/// are commas, names end with them and may have blanks in them. Blank lines are ignored, and so is
/// a first line of column names.
class CoordinateRows {
 public:
  /// @param name what errors call the stream
  CoordinateRows(std::istream& stream, std::string name, RowFormat format);

  /// Whether there is a row; its points stay until the next one is read.
  /// @throws FileError naming line, column, value and what is allowed
  bool next();

  /// What is in a column of names; empty where the row has none.
  std::string_view name(std::size_t index) const {
    return index < name_count_ ? fields_[index] : std::string_view();
  }

  Eigen::Vector3d point(std::size_t index) const {
    return Eigen::Vector3d(&coordinates_[3 * index]);
  }

 private:
  /// Whether there is a line that is not blank.
  bool next_fields();
  void split_row(std::string_view row);
  bool is_header() const;
  void read_coordinates();
  double read_coordinate(std::size_t field, const char* column) const;
  [[noreturn]] void refuse_field_count() const;

  LineReader lines_;
  const std::string name_;
  const RowFormat format_;
  std::size_t line_ = 0;
  bool is_first_ = true;  // of the lines that are not blank
  std::vector<std::string_view> between_commas_;
  std::vector<std::string_view> fields_;
  std::size_t name_count_ = 0;  // of the fields
  std::vector<double> coordinates_;
};

}  // namespace fiber

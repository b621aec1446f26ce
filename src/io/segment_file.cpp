#include "src/io/segment_file.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/io/csv_row.hpp"
#include "src/io/input_file.hpp"
#include "src/io/number.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

/// The parts of a row of a file of points.
struct RowFormat {
  /// Columns before the coordinates, as errors call them.
  std::vector<const char*> names;

  /// Those of the coordinates, of which there are three for each point.
  std::vector<std::string> coordinates;

  /// Whether a row that begins with a number has no name, unless the header begins with `name` and
  /// the row has a number more, and further columns are ignored.
  bool is_loose;

  /// How an error calls all coordinates together.
  const char* all_coordinates;
};

bool is_number(std::string_view text) { return parse_decimal_or_hex(text).has_value(); }

/// Appends the parts between blanks; nothing at all is an empty field.
void append_parts(std::string_view field, std::vector<std::string_view>& parts) {
  do {
    parts.push_back(field.substr(0, field.find_first_of(blanks)));
    field = trimmed(field.substr(parts.back().size()));
  } while (!field.empty());
}

/// The separator of the values of a row, beside blanks: the first that stands in no quotes.
char separator_in(std::string_view row) {
  bool is_quoted = false;
  for (const char letter : row) {
    is_quoted = is_quoted != (letter == '"');
    if (!is_quoted && (letter == ',' || letter == ';')) {
      return letter;
    }
  }
  return ' ';
}

/// Reads a file of points row by row. Fields are separated by commas or semicolons, by blanks or
/// both; where there are commas, names end with them and may have blanks in them, and so they may
/// in quotes. Blank lines are ignored, and so are comments and a first line of column names.
class CoordinateRows {
 public:
  /// @param name what errors call the stream
  CoordinateRows(std::istream& stream, std::string name, RowFormat format)
      : lines_(stream, name),
        name_(std::move(name)),
        format_(std::move(format)),
        coordinates_(format_.coordinates.size()) {}

  /// Whether there is a row; its points stay until the next one is read.
  /// @throws FileError naming line, column, value and what is allowed
  bool next() {
    bool found = next_fields();
    if (std::exchange(is_first_, false) && found && is_header()) {
      has_name_column_ = fields_.front() == "name";
      found = next_fields();
    }
    if (found) {
      read_coordinates();
    }
    return found;
  }

  /// The text of a column of names; empty where the row has none.
  std::string_view name(std::size_t index) const {
    return index < name_count_ ? fields_[index] : std::string_view();
  }

  Eigen::Vector3d point(std::size_t index) const {
    return Eigen::Vector3d(&coordinates_[3 * index]);
  }

 private:
  /// Whether there is a line that is neither blank nor a comment.
  bool next_fields() {
    for (std::string_view line; lines_.next(line);) {
      ++line_;
      line = trimmed(line);
      if (line.empty() || is_comment(line)) {
        continue;
      }
      if (const char* const problem = split_row(line)) {
        throw FileError(name_, line_,
                        "value " + std::to_string(row_.fields().size() + 1) + ' ' + problem);
      }
      check_fields(fields_, name_, line_);
      return true;
    }
    return false;
  }

  /// @throws FileError for one that is a row, too
  bool is_comment(std::string_view line) {
    if (line.front() != '#') {
      return false;
    }
    if (split_row(line) == nullptr && fields_.size() >= name_count_ + coordinates_.size() &&
        std::all_of(
            fields_.begin() + static_cast<std::ptrdiff_t>(name_count_),
            fields_.begin() + static_cast<std::ptrdiff_t>(name_count_ + coordinates_.size()),
            is_number)) {
      throw FileError(name_, line_,
                      "is a comment, or a row of the name " + quote(fields_.front()) +
                          ": a name that begins with # stands in quotes, and a comment is no row");
    }
    return true;
  }

  /// @return nullptr, or what is wrong
  const char* split_row(std::string_view row) {
    const char separator = separator_in(row);
    fields_.clear();
    if (const char* const problem = row_.split(row, separator)) {
      return problem;
    }
    const std::vector<std::string_view>& values = row_.fields();
    const std::string_view first = values.front();
    const bool has_names = !format_.is_loose ||
                           (has_name_column_ && values.size() > coordinates_.size()) ||
                           !is_number(first.substr(0, first.find_first_of(blanks)));
    name_count_ = has_names ? format_.names.size() : 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (separator == ' ' || i < name_count_) {
        fields_.push_back(values[i]);
      } else {
        append_parts(values[i], fields_);
      }
    }
    return nullptr;
  }

  bool is_header() const {
    return fields_.size() >= format_.coordinates.size() &&
           std::none_of(fields_.begin(), fields_.end(), is_number);
  }

  void read_coordinates() {
    const std::size_t expected = name_count_ + coordinates_.size();
    if (fields_.size() < expected || (fields_.size() > expected && !format_.is_loose)) {
      refuse_field_count();
    }
    for (std::size_t i = 0; i < coordinates_.size(); ++i) {
      coordinates_[i] = read_coordinate(name_count_ + i, format_.coordinates[i]);
    }
  }

  double read_coordinate(std::size_t field, const std::string& column) const {
    const std::optional<double> value = parse_decimal_or_hex(fields_[field]);
    if (!value || !FiberAssembly::is_valid_coordinate(*value)) {
      throw FileError(name_, line_,
                      "column " + std::to_string(field + 1) + " (" + column + ") is " +
                          quote(fields_[field]) + ", " +
                          (value ? FiberAssembly::coordinate_rule : "expected a number"));
    }
    return *value;
  }

  [[noreturn]] void refuse_field_count() const {
    const std::size_t names = std::min(name_count_, fields_.size());
    std::string reason = "has " + std::to_string(fields_.size() - names) + " values";
    for (std::size_t i = 0; i < names; ++i) {
      reason +=
          (i == 0 ? " after " : " and ") + std::string(format_.names[i]) + ' ' + quote(fields_[i]);
    }
    throw FileError(name_, line_, reason + ", expected " + format_.all_coordinates);
  }

  LineReader lines_;
  const std::string name_;
  const RowFormat format_;
  std::size_t line_ = 0;
  bool is_first_ = true;          // of the lines that are not blank
  bool has_name_column_ = false;  // as the header says
  CsvRow row_;
  std::vector<std::string_view> fields_;
  std::size_t name_count_ = 0;  // of the fields
  std::vector<double> coordinates_;
};

/// Makes an item of each row.
template <class Make>
auto read_rows(std::istream& stream, const std::string& name, const RowFormat& format,
               const Make& make) {
  CoordinateRows rows(stream, name, format);
  std::vector<decltype(make(rows))> items;
  while (rows.next()) {
    items.push_back(make(rows));
  }
  return items;
}

/// The columns of four points.
std::vector<std::string> columns_of(const std::array<const char*, 4>& points,
                                    const std::string& when) {
  std::vector<std::string> columns;
  for (const char* point : points) {
    for (const char* axis : {".x", ".y", ".z"}) {
      columns.push_back(point + (axis + when));
    }
  }
  return columns;
}

RowFormat pair_format() {
  return {{"the name"},
          columns_of({"p0", "p1", "q0", "q1"}, ""),
          true,
          "the 12 coordinates of p0, p1, q0 and q1"};
}

RowFormat motion_format() {
  constexpr std::array<const char*, 4> points{"a0", "a1", "b0", "b1"};
  std::vector<std::string> columns = columns_of(points, " at t = 0");
  for (const std::string& column : columns_of(points, " at t = 1")) {
    columns.push_back(column);
  }
  return {{"set", "truth"},
          columns,
          false,
          "the 24 coordinates of a0, a1, b0 and b1 at t = 0, then at t = 1"};
}

}  // namespace

std::vector<SegmentPair> read_segment_pairs(const std::string& path) {
  std::ifstream stream = open_to_read(path);
  return read_segment_pairs(stream, path);
}

std::vector<SegmentPair> read_segment_pairs(std::istream& stream, const std::string& name) {
  return read_rows(stream, name, pair_format(), [](const CoordinateRows& rows) {
    return SegmentPair{std::string(rows.name(0)), rows.point(0), rows.point(1), rows.point(2),
                       rows.point(3)};
  });
}

std::vector<MovingSegmentPair> read_segment_motions(const std::string& path) {
  std::ifstream stream = open_to_read(path);
  return read_segment_motions(stream, path);
}

std::vector<MovingSegmentPair> read_segment_motions(std::istream& stream, const std::string& name) {
  return read_rows(stream, name, motion_format(), [](const CoordinateRows& rows) {
    return MovingSegmentPair{std::string(rows.name(0)),      std::string(rows.name(1)),
                             {rows.point(0), rows.point(1)}, {rows.point(2), rows.point(3)},
                             {rows.point(4), rows.point(5)}, {rows.point(6), rows.point(7)}};
  });
}

}  // namespace fiber

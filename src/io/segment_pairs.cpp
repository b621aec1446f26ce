#include "fiber_proximity/io/segment_pairs.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/io/number.hpp"
#include "fiber_proximity/text/quote.hpp"
#include "src/io/input_file.hpp"
#include "src/io/text.hpp"

namespace fiber {
namespace {

using Fields = std::vector<std::string_view>;

constexpr const char* columns[] = {"p0.x", "p0.y", "p0.z", "p1.x", "p1.y", "p1.z",
                                   "q0.x", "q0.y", "q0.z", "q1.x", "q1.y", "q1.z"};
constexpr std::size_t column_count = std::size(columns);

bool is_number(std::string_view text) { return parse_decimal_or_hex(text).has_value(); }

/// Appends the parts between blanks; nothing between commas is an empty field.
void append_parts(std::string_view field, Fields& parts) {
  do {
    const std::size_t end = std::min(field.find_first_of(blanks), field.size());
    parts.push_back(field.substr(0, end));
    field = trimmed(field.substr(end));
  } while (!field.empty());
}

/// The fields of a line between commas and blanks; a name before a comma may have blanks in it.
void split_pair(std::string_view line, Fields& between_commas, Fields& fields) {
  fields.clear();
  split(line, between_commas);
  append_parts(between_commas.front(), fields);
  if (between_commas.size() > 1 && !is_number(fields.front())) {
    fields = {between_commas.front()};
  }
  for (std::size_t i = 1; i < between_commas.size(); ++i) {
    append_parts(between_commas[i], fields);
  }
}

/// Takes a file line by line.
class PairReader {
 public:
  explicit PairReader(std::string name) : name_(std::move(name)) {}

  void read_line(std::string_view line) {
    ++line_;
    line = trimmed(line);
    if (line.empty()) {
      return;
    }
    split_pair(line, between_commas_, fields_);
    check_fields(fields_, name_, line_);
    const bool first = std::exchange(is_first_, false);
    if (!(first && is_header())) {
      pairs_.push_back(read_pair());
    }
  }

  std::vector<SegmentPair> finish() { return std::move(pairs_); }

 private:
  bool is_header() const {
    return fields_.size() >= column_count &&
           std::none_of(fields_.begin(), fields_.end(), is_number);
  }

  SegmentPair read_pair() const {
    const std::size_t names = is_number(fields_.front()) ? 0 : 1;
    if (fields_.size() < names + column_count) {
      throw FileError(name_, line_,
                      "has " + std::to_string(fields_.size() - names) + " values" +
                          (names == 0 ? "" : " after the name " + quote(fields_.front())) +
                          ", expected the 12 coordinates of p0, p1, q0 and q1");
    }
    double values[column_count];
    for (std::size_t i = 0; i < column_count; ++i) {
      values[i] = read_coordinate(names + i, columns[i]);
    }
    return {Eigen::Vector3d(values), Eigen::Vector3d(values + 3), Eigen::Vector3d(values + 6),
            Eigen::Vector3d(values + 9)};
  }

  double read_coordinate(std::size_t field, const char* column) const {
    const std::optional<double> value = parse_decimal_or_hex(fields_[field]);
    if (!value || !FiberAssembly::is_valid_coordinate(*value)) {
      throw FileError(name_, line_,
                      "column " + std::to_string(field + 1) + " (" + column + ") is " +
                          quote(fields_[field]) + ", " +
                          (value ? FiberAssembly::coordinate_rule : "expected a number"));
    }
    return *value;
  }

  const std::string name_;
  std::size_t line_ = 0;
  bool is_first_ = true;  // of the lines that are not blank
  Fields between_commas_;
  Fields fields_;
  std::vector<SegmentPair> pairs_;
};

}  // namespace

std::vector<SegmentPair> read_segment_pairs(const std::string& path) {
  std::ifstream stream = open_to_read(path);
  return read_segment_pairs(stream, path);
}

std::vector<SegmentPair> read_segment_pairs(std::istream& stream, const std::string& name) {
  PairReader reader(name);
  for_each_line(stream, name, [&](std::string_view line) { reader.read_line(line); });
  return reader.finish();
}

}  // namespace fiber

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>
#include <unordered_map>
#include <utility>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/io/csv_columns.hpp"
#include "src/io/csv_row.hpp"
#include "src/io/file_format.hpp"
#include "src/io/frame_rows.hpp"
#include "src/io/input_file.hpp"
#include "src/io/number.hpp"
#include "src/io/radii.hpp"
#include "src/io/strands.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

/// Takes a file line by line and puts its frames together.
class CsvReader {
 public:
  CsvReader(std::string name, const ReadOptions& options)
      : name_(std::move(name)), options_(options) {
    check_default_radius(options.default_radius);
  }

  void read_line(std::string_view line) {
    if (++line_ == 1) {
      begin_ = line.substr(0, longest_begin);
    }
    const std::string_view text = trimmed(line);
    if (text.empty()) {
      return;
    }
    if (text.front() == '#') {
      read_comment(text);
    } else if (columns_ || take_header(line)) {
      split(line);
      read_row();
    }
  }

  FiberFile finish() {
    if (!columns_ && !commented_) {
      throw FileError(name_, std::string("is empty, ") + CsvColumns::rule);
    }
    if (!columns_) {
      take_columns(*commented_);
    }
    FiberFile file;
    file.has_frames = columns_->has(CsvColumns::FRAME);
    if (!file.has_frames) {
      enter_frame(0);
    }
    if (are_mixed_) {
      std::sort(frames_.begin(), frames_.end(),
                [](const FrameRows& x, const FrameRows& y) { return x.number < y.number; });
    }
    file.frames.reserve(frames_.size());
    for (; !frames_.empty(); frames_.pop_front()) {
      file.frames.push_back(builder_.build(std::move(frames_.front()), name_, options_));
    }
    if (!file.has_frames && !builder_.scattered().empty()) {
      notes_.push_back("rows of one fibre do not stand one after another, as of " +
                       quote(builder_.scattered()) +
                       ": without a column frame they are put together");
    }
    if (const auto& lonely = builder_.lonely_joint()) {
      notes_.push_back((file.has_frames ? "frame " + std::to_string(lonely->first) + ": " : "") +
                       "joint " + std::to_string(lonely->second) +
                       " is the number of one point alone: it joins nothing");
    }
    if (builder_.skipped() > 0) {
      notes_.push_back(note_of_skipped(builder_.skipped()));
    }
    file.notes = std::move(notes_);
    return file;
  }

 private:
  [[noreturn]] void refuse(const std::string& reason) const {
    throw FileError(name_, line_, reason);
  }

  /// Before the rows it may be the header, as numpy writes it: the last one that could be.
  void read_comment(std::string_view text) {
    const std::optional<CsvColumns>& known = columns_ ? columns_ : commented_;
    if (known && known->places[CsvColumns::FIBER] == 0 && is_row(text, *known)) {
      refuse("is a comment, or a row of fibre " + quote(row_.fields().front()) +
             ": a name that begins with # stands in quotes, and a comment is no row");
    }
    if (!columns_) {
      text.remove_prefix(std::min(text.size(), text.find_first_not_of('#')));
      const auto columns = columns_in(text);
      if (columns && columns->twice.empty()) {
        commented_ = columns;
      }
    }
  }

  bool is_row(std::string_view text, const CsvColumns& columns) {
    const auto is_number = [&](CsvColumns::Column column) {
      return parse_number<double>(row_.fields()[columns.places[column]]).has_value();
    };
    return row_.split(text, columns.separator) == nullptr &&
           row_.fields().size() == columns.count && is_number(CsvColumns::X) &&
           is_number(CsvColumns::Y) && is_number(CsvColumns::Z);
  }

  /// @return whether the line is a row already, as the header was a comment
  bool take_header(std::string_view line) {
    const auto columns = columns_in(line);
    row_.split(line, columns ? columns->separator : ',');
    check_fields(row_.fields(), name_, line_);
    if (columns) {
      take_columns(*columns);
      return false;
    }
    if (!commented_ || row_.split(line, commented_->separator) != nullptr ||
        row_.fields().size() != commented_->count) {
      const std::string format = format_of_content(begin_);
      refuse(format.empty() ? "the header is " + quote(trimmed(line)) + ", " + CsvColumns::rule
                            : "is " + format);
    }
    take_columns(*commented_);
    return true;
  }

  void take_columns(const CsvColumns& columns) {
    if (!columns.twice.empty()) {
      refuse("the header has the column " + columns.twice + " twice");
    }
    columns_ = columns;
    if (!columns.others.empty()) {
      notes_.push_back(note_of_others());
    }
  }

  /// The note that names columns that are not read.
  std::string note_of_others() const {
    constexpr std::size_t max_names = 5;
    const std::vector<std::string>& others = columns_->others;
    std::string note = others.size() == 1 ? "column " : "columns ";
    for (std::size_t i = 0; i < others.size() && i < max_names; ++i) {
      note += (i == 0 ? "" : ", ") + quote(others[i]);
    }
    if (others.size() > max_names) {
      note += " and " + std::to_string(others.size() - max_names) + " more";
    }
    note += others.size() == 1 ? " is not read" : " are not read";
    return note + (columns_->has(CsvColumns::FIBER) ? ""
                   : columns_->has(CsvColumns::FRAME)
                       ? "; there is no column fiber: the rows of a frame are one fibre"
                       : "; there is no column fiber: all rows are one fibre");
  }

  void split(std::string_view line) {
    if (const char* const problem = row_.split(line, columns_->separator)) {
      refuse("value " + std::to_string(row_.fields().size() + 1) + ' ' + problem);
    }
    check_fields(row_.fields(), name_, line_);
    if (row_.fields().size() != columns_->count) {
      refuse("has " + std::to_string(row_.fields().size()) + " values, expected " +
             std::to_string(columns_->count) + " as in the header");
    }
  }

  std::string_view field(CsvColumns::Column column) const {
    return row_.fields()[columns_->places[column]];
  }

  void read_row() {
    enter_frame(columns_->has(CsvColumns::FRAME) ? read_frame(field(CsvColumns::FRAME)) : 0);
    enter_fiber(columns_->has(CsvColumns::FIBER) ? field(CsvColumns::FIBER) : "0");
    Eigen::Vector3d& point = rows_->points.emplace_back();
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view text = field(static_cast<CsvColumns::Column>(CsvColumns::X + axis));
      const char name[] = {"xyz"[axis], '\0'};
      point[axis] = read_double(name, text);
      if (!FiberAssembly::is_valid_coordinate(point[axis])) {
        refuse(name + (" is " + quote(text)) + ", " + FiberAssembly::coordinate_rule);
      }
    }
    if (columns_->has(CsvColumns::RADIUS)) {
      const std::string_view text = field(CsvColumns::RADIUS);
      rows_->radii.push_back(read_double("radius", text));
      if (!FiberAssembly::is_valid_radius(rows_->radii.back())) {
        refuse("radius is " + quote(text) + ", " + FiberAssembly::radius_rule);
      }
    }
    if (columns_->has(CsvColumns::CLOSED)) {
      rows_->closed.push_back(read_closed(field(CsvColumns::CLOSED)));
    }
    if (columns_->has(CsvColumns::JOINT)) {
      rows_->joints.push_back(read_joint(field(CsvColumns::JOINT)));
    }
  }

  std::uint8_t read_closed(std::string_view text) const {
    if (text != "0" && text != "1") {
      refuse("closed is " + quote(text) + ", expected 0 or 1");
    }
    return text == "1" ? 1 : 0;
  }

  /// Nothing stands for a point that is not joined.
  std::int32_t read_joint(std::string_view text) const {
    const auto joint =
        text.empty() ? std::optional<std::int32_t>(-1) : parse_number<std::int32_t>(text);
    if (!joint) {
      refuse("joint is " + quote(text) + ", expected a whole number below 2147483648, or nothing");
    }
    return *joint;
  }

  /// Also of numbers that a program writes as 3.000e+00.
  std::int64_t read_frame(std::string_view text) const {
    if (const auto frame = parse_number<std::int64_t>(text)) {
      return *frame;
    }
    constexpr double max_whole =
        9'007'199'254'740'992.0;  // 2⁵³: below it doubles are every whole number
    const auto number = parse_number<double>(text);
    if (!number || !(std::abs(*number) < max_whole) || *number != std::floor(*number)) {
      refuse("frame is " + quote(text) + ", expected a whole number");
    }
    return static_cast<std::int64_t>(*number);
  }

  double read_double(const char* name, std::string_view text) const {
    const auto value = parse_number<double>(text);
    if (!value) {
      refuse(name + (" is " + quote(text)) + ", expected a number" +
             (text.find(',') == std::string_view::npos ? "" : " with a decimal point"));
    }
    return *value;
  }

  void enter_frame(std::int64_t frame) {
    if (rows_ != nullptr && frame == rows_->number) {
      return;
    }
    FrameRows*& rows = frames_by_number_[frame];
    are_mixed_ = are_mixed_ || rows != nullptr;
    if (rows == nullptr) {
      rows = &frames_.emplace_back();
      rows->number = frame;
    }
    rows_ = rows;
    is_new_run_ = true;
  }

  void enter_fiber(std::string_view label) {
    if (!is_new_run_ && label == label_) {
      return;
    }
    if (label.empty()) {
      refuse("fiber is empty, expected a name");
    }
    label_ = label;
    is_new_run_ = false;
    rows_->runs.push_back({builder_.number_of(label), rows_->points.size(), line_});
  }

  static constexpr std::size_t longest_begin = 16;  // [byte] enough to know other formats by

  const std::string name_;
  const ReadOptions& options_;
  std::vector<std::string> notes_;
  std::string begin_;                    // of the file
  std::optional<CsvColumns> columns_;    // nothing before the header
  std::optional<CsvColumns> commented_;  // of a header that is a comment, if it is one

  std::size_t line_ = 0;
  CsvRow row_;

  std::deque<FrameRows> frames_;
  std::unordered_map<std::int64_t, FrameRows*> frames_by_number_;
  bool are_mixed_ = false;     // whether rows of a frame stand between those of another
  FrameRows* rows_ = nullptr;  // the frame of the row before
  bool is_new_run_ = true;     // whether the next row is of another frame
  std::string label_;
  FrameBuilder builder_;
};

}  // namespace

FiberFile read_csv(const std::string& path, const ReadOptions& options) {
  std::ifstream stream = open_to_read(path);
  return read_csv(stream, path, options);
}

FiberFile read_csv(std::istream& stream, const std::string& name, const ReadOptions& options) {
  CsvReader reader(name, options);
  for_each_line(stream, name, [&](std::string_view line) { reader.read_line(line); });
  return reader.finish();
}

}  // namespace fiber

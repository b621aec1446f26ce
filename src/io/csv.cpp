#include <set>
#include <stdexcept>
#include <string_view>
#include <unordered_set>
#include <utility>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/io/input_file.hpp"
#include "src/io/number.hpp"
#include "src/io/radii.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

/// Takes a file line by line and puts its frames together.
class CsvReader {
 public:
  CsvReader(std::string name, double default_radius)
      : name_(std::move(name)), default_radius_(default_radius) {
    check_default_radius(default_radius);
  }

  void read_line(std::string_view line) {
    ++line_;
    if (trimmed(line).empty()) {
      return;
    }
    split(line, fields_);
    check_fields(fields_, name_, line_);
    if (columns_ == 0) {
      read_header();
    } else {
      read_row();
    }
  }

  FiberFile finish() {
    if (columns_ == 0) {
      throw FileError(name_, "is empty, expected the header " + std::string(header_rule));
    }
    if (!file_.has_frames || in_frame_) {
      close_frame();
    }
    return std::move(file_);
  }

 private:
  static constexpr const char* header_rule = "[frame,]fiber,x,y,z[,radius]";

  [[noreturn]] void refuse(const std::string& reason) const {
    throw FileError(name_, line_, reason);
  }

  void read_header() {
    columns_ = fields_.size();
    std::vector<std::string_view> expected{"fiber", "x", "y", "z"};
    file_.has_frames = fields_.front() == "frame";
    if (file_.has_frames) {
      expected.insert(expected.begin(), "frame");
    }
    has_radius_ = fields_.back() == "radius";
    if (has_radius_) {
      expected.emplace_back("radius");
    }
    if (fields_ != expected) {
      std::string header;
      for (const std::string_view field : fields_) {
        header += (header.empty() ? "" : ",") + std::string(field);
      }
      refuse("the header is " + quote(header) + ", expected " + header_rule);
    }
  }

  void read_row() {
    if (fields_.size() != columns_) {
      refuse("has " + std::to_string(fields_.size()) + " values, expected " +
             std::to_string(columns_) + " as in the header");
    }
    std::size_t column = 0;
    if (file_.has_frames) {
      enter_frame(read_frame(fields_[column++]));
    }
    enter_fiber(fields_[column++]);
    Eigen::Vector3d point;
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view text = fields_[column++];
      const char name[] = {"xyz"[axis], '\0'};
      point[axis] = read_double(name, text);
      if (!FiberAssembly::is_valid_coordinate(point[axis])) {
        refuse(name + (" is " + quote(text)) + ", " + FiberAssembly::coordinate_rule);
      }
    }
    points_.push_back(point);
    if (has_radius_) {
      radii_.push_back(read_double("radius", fields_[column]));
      if (!FiberAssembly::is_valid_radius(radii_.back())) {
        refuse("radius is " + quote(fields_[column]) + ", " + FiberAssembly::radius_rule);
      }
    }
  }

  std::int64_t read_frame(std::string_view text) const {
    const auto frame = parse_number<std::int64_t>(text);
    if (!frame) {
      refuse("frame is " + quote(text) + ", expected a whole number");
    }
    return *frame;
  }

  double read_double(const char* name, std::string_view text) const {
    const auto value = parse_number<double>(text);
    if (!value) {
      refuse(name + (" is " + quote(text)) + ", expected a number");
    }
    return *value;
  }

  void enter_frame(std::int64_t frame) {
    if (in_frame_ && frame == frame_) {
      return;
    }
    if (in_frame_) {
      close_frame();
    }
    if (!frames_seen_.insert(frame).second) {
      refuse("frame " + std::to_string(frame) +
             " appears again; the rows of a frame must stand one after another");
    }
    frame_ = frame;
    in_frame_ = true;
  }

  void enter_fiber(std::string_view label) {
    if (!offsets_.empty() && label == label_) {
      return;
    }
    close_fiber();
    if (label.empty()) {
      refuse("fiber is empty, expected a label");
    }
    if (!labels_seen_.insert(std::string(label)).second) {
      refuse("fibre " + quote(label) +
             " appears again; the rows of a fibre must stand one after another");
    }
    label_ = label;
    fiber_line_ = line_;
    offsets_.push_back(static_cast<std::uint32_t>(points_.size()));
  }

  void close_fiber() const {
    if (!offsets_.empty() && points_.size() - offsets_.back() < 2) {
      throw FileError(name_, fiber_line_,
                      "fibre " + quote(label_) + " has only this point, a fibre needs at least 2");
    }
  }

  void close_frame() {
    close_fiber();
    offsets_.push_back(static_cast<std::uint32_t>(points_.size()));
    if (radii_.empty()) {
      radii_.push_back(default_radius_);
    }
    file_.frames.push_back(
        {frame_, FiberAssembly(std::exchange(points_, {}), std::exchange(offsets_, {}),
                               shared_if_equal(std::exchange(radii_, {})))});
    labels_seen_.clear();
  }

  const std::string name_;
  const double default_radius_;  // [m]
  FiberFile file_;
  std::size_t columns_ = 0;  // 0 before the header
  bool has_radius_ = false;

  std::size_t line_ = 0;
  std::vector<std::string_view> fields_;

  bool in_frame_ = false;
  std::int64_t frame_ = 0;
  std::set<std::int64_t> frames_seen_;

  std::string label_;
  std::size_t fiber_line_ = 0;
  std::unordered_set<std::string> labels_seen_;

  // Of the frame being read; offsets are those of the fibres begun.
  std::vector<Eigen::Vector3d> points_;
  std::vector<std::uint32_t> offsets_;
  std::vector<double> radii_;
};

void append_rows(std::string& text, const FiberFrame& frame, bool has_frames) {
  const std::vector<std::uint32_t>& offsets = frame.fibers.offsets();
  for (std::size_t fiber = 0; fiber < frame.fibers.fiber_count(); ++fiber) {
    for (std::size_t point = offsets[fiber]; point < offsets[fiber + 1]; ++point) {
      if (has_frames) {
        append_number(text, frame.frame);
        text += ',';
      }
      append_number(text, fiber);
      const Eigen::Vector3d& position = frame.fibers.points()[point];
      for (const double coordinate : {position.x(), position.y(), position.z()}) {
        text += ',';
        append_number(text, coordinate);
      }
      text += ',';
      append_number(text, point_radius(frame.fibers, fiber, point));
      text += '\n';
    }
  }
}

}  // namespace

FiberFile read_csv(const std::string& path, double default_radius) {
  std::ifstream stream = open_to_read(path);
  return read_csv(stream, path, default_radius);
}

FiberFile read_csv(std::istream& stream, const std::string& name, double default_radius) {
  CsvReader reader(name, default_radius);
  for_each_line(stream, name, [&](std::string_view line) { reader.read_line(line); });
  return reader.finish();
}

CsvWriter::CsvWriter(const std::string& path, bool has_frames)
    : has_frames_(has_frames), file_(path) {
  file_.write(has_frames ? "frame,fiber,x,y,z,radius\n" : "fiber,x,y,z,radius\n");
}

void CsvWriter::write(const FiberFrame& frame) {
  if (!has_frames_ && !frames_written_.empty()) {
    throw std::invalid_argument("a file without frame numbers holds only one frame");
  }
  if (has_frames_ && frame.fibers.fiber_count() == 0) {
    throw std::invalid_argument("frame " + std::to_string(frame.frame) +
                                " has no fibres, a file with frames cannot hold it");
  }
  if (!frames_written_.insert(frame.frame).second) {
    throw std::invalid_argument("frame " + std::to_string(frame.frame) + " was written before");
  }
  rows_.clear();
  append_rows(rows_, frame, has_frames_);
  file_.write(rows_);
}

void CsvWriter::finish() { file_.close(); }

}  // namespace fiber

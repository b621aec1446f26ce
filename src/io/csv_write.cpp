#include <stdexcept>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/io/number.hpp"
#include "src/io/radii.hpp"
#include "src/text/csv_field.hpp"

namespace fiber {
namespace {

void append_name(std::string& text, const FiberNames& names, std::size_t fiber) {
  if (names.are_indices()) {
    append_number(text, fiber);
  } else {
    append_csv_field(text, names.of(fiber));
  }
}

/// Which columns there are, beside those that always are.
struct Columns {
  bool frames;
  bool joints;
};

void append_rows(std::string& text, const FiberFrame& frame, Columns columns) {
  const FiberTopology topology = frame.fibers.topology();
  const std::vector<std::uint32_t>& given = frame.fibers.given_offsets();
  for (std::size_t fiber = 0; fiber < frame.fibers.fiber_count(); ++fiber) {
    for (std::size_t i = 0; i < given[fiber + 1] - given[fiber]; ++i) {
      const std::size_t point = frame.fibers.offsets()[fiber] + i;
      if (columns.frames) {
        append_number(text, frame.frame);
        text += ',';
      }
      append_name(text, frame.names, fiber);
      const Eigen::Vector3d& position = frame.fibers.points()[point];
      for (const double coordinate : {position.x(), position.y(), position.z()}) {
        text += ',';
        append_number(text, coordinate);
      }
      text += ',';
      append_number(text, frame.fibers.radius_at(fiber, point));
      if (columns.joints) {
        text += frame.fibers.is_closed(fiber) ? ",1," : ",0,";
        if (!topology.joints.empty() && topology.joints[given[fiber] + i] >= 0) {
          append_number(text, topology.joints[given[fiber] + i]);
        }
      }
      text += '\n';
    }
  }
}

}  // namespace

CsvWriter::CsvWriter(const std::string& path, bool has_frames)
    : has_frames_(has_frames), file_(path) {}

/// The first frame tells whether there are columns of what is joined.
void CsvWriter::begin(bool has_joints) {
  has_joints_ = has_joints;
  file_.write(has_frames_ ? "frame,fiber,x,y,z,radius" : "fiber,x,y,z,radius");
  file_.write(has_joints ? ",closed,joint\n" : "\n");
}

void CsvWriter::write(const FiberFrame& frame) {
  if (!has_frames_ && !frames_written_.empty()) {
    throw std::invalid_argument("a file without frame numbers holds only one frame");
  }
  if (has_frames_ && frame.fibers.fiber_count() == 0) {
    throw std::invalid_argument("frame " + std::to_string(frame.frame) +
                                " has no fibres, a file with frames cannot hold it");
  }
  if (!frame.names.are_indices() && frame.names.size() != frame.fibers.fiber_count()) {
    throw std::invalid_argument(std::to_string(frame.names.size()) + " names for " +
                                std::to_string(frame.fibers.fiber_count()) + " fibres");
  }
  if (!frames_written_.insert(frame.frame).second) {
    throw std::invalid_argument("frame " + std::to_string(frame.frame) + " was written before");
  }
  const bool has_joints = frame.fibers.graph() != nullptr;
  if (frames_written_.size() > 1 && has_joints && !has_joints_) {
    throw std::invalid_argument("frame " + std::to_string(frame.frame) +
                                " has fibres that are closed or joined, the first frame has none: "
                                "the file has no columns for them");
  }
  if (frames_written_.size() == 1) {
    begin(has_joints);
  }
  rows_.clear();
  append_rows(rows_, frame, {has_frames_, has_joints_});
  file_.write(rows_);
}

void CsvWriter::finish() {
  if (frames_written_.empty()) {
    begin(false);
  }
  file_.close();
}

}  // namespace fiber

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

/// @param topology of the fibres, where the file has columns for it
void append_rows(std::string& text, const FiberFrame& frame, bool has_frames,
                 const std::optional<FiberTopology>& topology) {
  const std::vector<std::uint32_t>& offsets = frame.fibers.offsets();
  const std::vector<std::uint32_t>& given = frame.fibers.given_offsets();
  for (std::size_t fiber = 0; fiber < frame.fibers.fiber_count(); ++fiber) {
    for (std::uint32_t i = given[fiber]; i < given[fiber + 1]; ++i) {
      const std::size_t point = i + (offsets[fiber] - given[fiber]);
      if (has_frames) {
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
      if (topology) {
        text += frame.fibers.is_closed(fiber) ? ",1," : ",0,";
        if (!topology->joints.empty() && topology->joints[i] >= 0) {
          append_number(text, topology->joints[i]);
        }
      }
      text += '\n';
    }
  }
}

}  // namespace

CsvWriter::CsvWriter(const std::string& path, bool has_frames)
    : has_frames_(has_frames), file_(path) {}

void CsvWriter::write_header(bool has_topology) {
  has_topology_ = has_topology;
  file_.write(std::string(has_frames_ ? "frame," : "") + "fiber,x,y,z,radius" +
              (has_topology ? ",closed,joint\n" : "\n"));
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
  const bool has_topology = frame.fibers.graph() != nullptr;
  if (has_topology_ && has_topology && !*has_topology_) {
    throw std::invalid_argument("frame " + std::to_string(frame.frame) +
                                " has closed or joined fibres, and the first frame had none: the "
                                "file has no columns for them");
  }
  if (!frames_written_.insert(frame.frame).second) {
    throw std::invalid_argument("frame " + std::to_string(frame.frame) + " was written before");
  }
  if (!has_topology_) {
    write_header(has_topology);
  }
  rows_.clear();
  append_rows(rows_, frame, has_frames_,
              *has_topology_ ? std::make_optional(frame.fibers.topology()) : std::nullopt);
  file_.write(rows_);
}

void CsvWriter::finish() {
  if (!has_topology_) {
    write_header(false);
  }
  file_.close();
}

}  // namespace fiber

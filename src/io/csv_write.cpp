#include <cerrno>
#include <fstream>
#include <set>
#include <stdexcept>

#include "fiber_proximity/io/csv.hpp"
#include "fiber_proximity/io/number.hpp"

namespace fiber {
namespace {

double point_radius(const FiberAssembly& fibers, std::size_t fiber, std::size_t point) {
  const std::vector<double>& radii = fibers.radii();
  if (radii.size() == 1) {
    return radii.front();
  }
  return radii.size() == fibers.fiber_count() ? radii[fiber] : radii[point];
}

void append_rows(std::string& text, const FiberFrame& frame, bool has_frames) {
  const std::vector<std::uint32_t>& offsets = frame.fibers.offsets();
  for (std::size_t fiber = 0; fiber < frame.fibers.fiber_count(); ++fiber) {
    for (std::size_t point = offsets[fiber]; point < offsets[fiber + 1]; ++point) {
      if (has_frames) {
        append_number(text, frame.frame);
        text += ',';
      }
      append_number(text, fiber);
      for (const double coordinate : frame.fibers.points()[point]) {
        text += ',';
        append_number(text, coordinate);
      }
      text += ',';
      append_number(text, point_radius(frame.fibers, fiber, point));
      text += '\n';
    }
  }
}

void check_writable(const FiberFile& file) {
  if (!file.has_frames && file.frames.size() != 1) {
    throw std::invalid_argument("a file without frame numbers holds exactly 1 frame, not " +
                                std::to_string(file.frames.size()));
  }
  std::set<std::int64_t> seen;
  for (const FiberFrame& frame : file.frames) {
    if (file.has_frames && frame.fibers.fiber_count() == 0) {
      throw std::invalid_argument("frame " + std::to_string(frame.frame) +
                                  " has no fibres, a file with frames cannot hold it");
    }
    if (!seen.insert(frame.frame).second) {
      throw std::invalid_argument("frame number " + std::to_string(frame.frame) +
                                  " appears more than once");
    }
  }
}

}  // namespace

void write_csv(const std::string& path, const FiberFile& file) {
  check_writable(file);
  errno = 0;
  std::ofstream stream(path, std::ios::binary);
  if (!stream) {
    throw FileError::from_system(path, "cannot be opened for writing");
  }
  write_csv(stream, file);
  stream.close();
  if (!stream) {
    throw FileError::from_system(path, "cannot be written");
  }
}

void write_csv(std::ostream& stream, const FiberFile& file) {
  check_writable(file);
  stream << (file.has_frames ? "frame,fiber,x,y,z,radius\n" : "fiber,x,y,z,radius\n");
  std::string text;
  for (const FiberFrame& frame : file.frames) {
    text.clear();
    append_rows(text, frame, file.has_frames);
    stream << text;
  }
}

}  // namespace fiber

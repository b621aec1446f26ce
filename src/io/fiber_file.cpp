#include "fiber_proximity/io/fiber_file.hpp"

#include <filesystem>
#include <stdexcept>

#include "fiber_proximity/io/hair_file.hpp"

namespace fiber {
namespace {

/// @param format an extension of small letters
bool has_format(const std::string& path, const char* format) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& letter : extension) {
    if (letter >= 'A' && letter <= 'Z') {
      letter = static_cast<char>(letter - 'A' + 'a');
    }
  }
  return extension == format;
}

}  // namespace

FiberFile read_fibers(const std::string& path, double default_radius) {
  return has_format(path, ".hair") ? read_hair(path, default_radius)
                                   : read_csv(path, default_radius);
}

FiberWriter::FiberWriter(const std::string& path, bool has_frames)
    : path_(path), has_frames_(has_frames) {
  if (has_format(path, ".pvd")) {
    pvd_.emplace(path);
  } else if (!has_format(path, ".hair")) {
    csv_.emplace(path, has_frames);
  }
}

void FiberWriter::write(const FiberFrame& frame, std::optional<double> time) {
  if (csv_) {
    csv_->write(frame);
    return;
  }
  if (pvd_) {
    pvd_->write(frame, time.value_or(static_cast<double>(frame.frame)));
    return;
  }
  if (wrote_hair_) {
    throw std::invalid_argument("a .hair file holds only one frame");
  }
  write_hair(path_, {has_frames_, {frame}});
  wrote_hair_ = true;
}

void FiberWriter::finish() {
  if (csv_) {
    csv_->finish();
  } else if (!pvd_ && !wrote_hair_) {
    throw std::invalid_argument("a .hair file holds exactly one frame, none was written");
  }
}

void write_fibers(const std::string& path, const FiberFile& file) {
  FiberWriter writer(path, file.has_frames);
  for (const FiberFrame& frame : file.frames) {
    writer.write(frame);
  }
  writer.finish();
}

}  // namespace fiber

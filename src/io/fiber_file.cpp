#include "fiber_proximity/io/fiber_file.hpp"

#include <filesystem>
#include <stdexcept>

#include "fiber_proximity/io/hair_file.hpp"

namespace fiber {
namespace {

bool is_hair(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& letter : extension) {
    if (letter >= 'A' && letter <= 'Z') {
      letter = static_cast<char>(letter - 'A' + 'a');
    }
  }
  return extension == ".hair";
}

}  // namespace

FiberFile read_fibers(const std::string& path, double default_radius) {
  return is_hair(path) ? read_hair(path, default_radius) : read_csv(path, default_radius);
}

FiberWriter::FiberWriter(const std::string& path, bool has_frames)
    : path_(path), has_frames_(has_frames) {
  if (!is_hair(path)) {
    csv_.emplace(path, has_frames);
  }
}

void FiberWriter::write(const FiberFrame& frame) {
  if (csv_) {
    csv_->write(frame);
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
  } else if (!wrote_hair_) {
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

#include "fiber_proximity/io/fiber_file.hpp"

#include <filesystem>
#include <stdexcept>

#include "src/io/fiber_formats.hpp"
#include "src/io/file_format.hpp"
#include "src/io/input_file.hpp"
#include "src/io/one_frame.hpp"

namespace fiber {
namespace {

template <class Writer>
void write_all(const std::string& path, const FiberFile& file) {
  Writer writer(path, file.has_frames);
  for (const FiberFrame& frame : file.frames) {
    writer.write(frame);
  }
  writer.finish();
}

}  // namespace

FiberFile read_fibers(const std::string& path, const ReadOptions& options) {
  require_format_to_read(path);
  std::ifstream stream = open_to_read(path);
  switch (format_of(path)) {
    case FileFormat::HAIR:
      return read_hair(stream, path, options);
    case FileFormat::NPZ:
      return read_npz(stream, path, options);
    case FileFormat::SWC:
      return read_swc(stream, path, options);
    case FileFormat::TCK:
      return read_tck(stream, path, options);
    case FileFormat::TRK:
      return read_trk(stream, path, options);
    case FileFormat::VTK:
      return read_vtk(stream, path, options);
    case FileFormat::VTP:
      return read_vtp(stream, path, options);
    default:
      return read_csv(stream, path, options);
  }
}

FiberWriter::FiberWriter(const std::string& path, bool has_frames)
    : path_(path), has_frames_(has_frames) {
  require_format_to_write(path);
  const FileFormat format = format_of(path);
  if (format == FileFormat::PVD) {
    pvd_.emplace(path);
  } else if (format == FileFormat::CSV) {
    csv_.emplace(path, has_frames);
  } else if (has_frames) {
    refuse_to_encode(end_of_name().c_str(),
                     "it holds exactly 1 frame without a number, not frames with numbers");
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
  if (wrote_frame_) {
    throw std::invalid_argument("a " + end_of_name() + " file holds only one frame");
  }
  // A file that cannot be made is not left behind half.
  const std::string bytes = encoded(format_of(path_), {has_frames_, {frame}});
  OutputFile file(path_);
  file.write(bytes);
  file.close();
  wrote_frame_ = true;
}

void FiberWriter::finish() {
  if (csv_) {
    csv_->finish();
  } else if (!pvd_ && !wrote_frame_) {
    throw std::invalid_argument("a " + end_of_name() +
                                " file holds exactly one frame, none was written");
  }
}

std::string FiberWriter::end_of_name() const {
  return std::filesystem::path(path_).extension().string();
}

void write_csv(const std::string& path, const FiberFile& file) { write_all<CsvWriter>(path, file); }

void write_fibers(const std::string& path, const FiberFile& file) {
  write_all<FiberWriter>(path, file);
}

}  // namespace fiber

#include "src/io/one_frame.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "src/io/fiber_formats.hpp"
#include "src/io/number.hpp"

namespace fiber {
namespace {

bool has_places_of_radii(FileFormat format) { return format != FileFormat::TCK; }
bool has_places_of_graphs(FileFormat format) {
  return format == FileFormat::NPZ || format == FileFormat::VTP;
}

}  // namespace

std::string encoded(FileFormat format, const FiberFile& file) {
  std::ostringstream stream;
  switch (format) {
    case FileFormat::HAIR:
      write_hair(stream, file);
      break;
    case FileFormat::NPZ:
      write_npz(stream, file);
      break;
    case FileFormat::TCK:
      write_tck(stream, file);
      break;
    case FileFormat::TRK:
      write_trk(stream, file);
      break;
    default:
      assert(format == FileFormat::VTP);
      write_vtp(stream, only_frame(".vtp", file).fibers);
  }
  return stream.str();
}

std::vector<std::string> losses(FileFormat format, const FiberFrame& frame) {
  std::vector<std::string> lost;
  if (!frame.names.are_indices()) {
    lost.emplace_back("the format has no names: fibres are only in their order");
  }
  if (has_radii(frame.fibers) && !has_places_of_radii(format)) {
    lost.emplace_back("the format has no radii: fibres are only their axes");
  }
  if (frame.fibers.graph() != nullptr && !has_places_of_graphs(format)) {
    lost.emplace_back(
        "the format has no closed or joined fibres: rings are chains that end where they begin");
  }
  return lost;
}

void refuse_to_encode(const char* end, const std::string& reason) {
  throw std::invalid_argument("a " + std::string(end) + " file cannot hold this: " + reason);
}

const FiberFrame& only_frame(const char* end, const FiberFile& file) {
  if (file.has_frames || file.frames.size() != 1) {
    refuse_to_encode(end, "it holds exactly 1 frame without a number, not " +
                              std::to_string(file.frames.size()) +
                              (file.has_frames ? " with numbers" : ""));
  }
  return file.frames.front();
}

float single_precision(const char* end, double value, const char* what, std::size_t fiber,
                       std::size_t point) {
  if (std::abs(value) > std::numeric_limits<float>::max()) {
    refuse_to_encode(end, "fibre " + std::to_string(fiber) + ", point " + std::to_string(point) +
                              ": " + what + " is " + text_of(value) + ", beyond single precision");
  }
  return static_cast<float>(value);
}

bool has_radii(const FiberAssembly& fibers) {
  return fibers.fiber_count() > 0 && std::any_of(fibers.radii().begin(), fibers.radii().end(),
                                                 [](double radius) { return radius != 0.0; });
}

}  // namespace fiber

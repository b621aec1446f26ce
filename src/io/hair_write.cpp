#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/io/hair_format.hpp"
#include "src/io/number.hpp"
#include "src/io/radii.hpp"

namespace fiber {
namespace {

using namespace hair_format;

void append_uint16(std::string& bytes, std::uint32_t value) {
  bytes += static_cast<char>(value & 0xffU);
  bytes += static_cast<char>((value >> 8U) & 0xffU);
}

void append_uint32(std::string& bytes, std::uint32_t value) {
  append_uint16(bytes, value);
  append_uint16(bytes, value >> 16U);
}

void append_float32(std::string& bytes, float value) {
  std::uint32_t bits = 0;
  static_assert(sizeof(value) == sizeof(bits));
  std::memcpy(&bits, &value, sizeof(bits));
  append_uint32(bytes, bits);
}

[[noreturn]] void refuse(const std::string& reason) {
  throw std::invalid_argument("a .hair file cannot hold this: " + reason);
}

float single_precision(double value, const char* what, std::size_t fiber, std::size_t point) {
  if (std::abs(value) > std::numeric_limits<float>::max()) {
    std::string text;
    append_number(text, value);
    refuse("fibre " + std::to_string(fiber) + ", point " + std::to_string(point) + ": " + what +
           " is " + text + ", beyond single precision");
  }
  return static_cast<float>(value);
}

std::uint32_t segments_of(const FiberAssembly& fibers, std::size_t fiber) {
  return fibers.offsets()[fiber + 1] - fibers.offsets()[fiber] - 1;
}

/// The number of segments of every fibre, or 0 if they differ.
std::uint32_t common_segments(const FiberAssembly& fibers) {
  const std::uint32_t segments = fibers.fiber_count() == 0 ? 0 : segments_of(fibers, 0);
  for (std::size_t fiber = 1; fiber < fibers.fiber_count(); ++fiber) {
    if (segments_of(fibers, fiber) != segments) {
      return 0;
    }
  }
  return segments;
}

std::string header(const FiberAssembly& fibers, std::uint32_t flags) {
  std::string bytes(signature, sizeof(signature));
  append_uint32(bytes, static_cast<std::uint32_t>(fibers.fiber_count()));
  append_uint32(bytes, static_cast<std::uint32_t>(fibers.point_count()));
  append_uint32(bytes, flags);
  append_uint32(bytes, common_segments(fibers));
  const bool shared_radius = (flags & THICKNESS) == 0;
  const double thickness = shared_radius ? 2.0 * fibers.radii().front() : 0.0;
  append_float32(bytes, single_precision(thickness, "the thickness", 0, 0));
  append_float32(bytes, 0.0F);  // opaque
  for (int channel = 0; channel < 3; ++channel) {
    append_float32(bytes, 1.0F);  // white
  }
  bytes += "written by fiber_proximity, lengths in metres";
  bytes.resize(header_size, '\0');
  return bytes;
}

void append_segments(std::string& bytes, const FiberAssembly& fibers) {
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const std::uint32_t segments = segments_of(fibers, fiber);
    constexpr std::uint32_t most_segments = std::numeric_limits<std::uint16_t>::max();
    if (segments > most_segments) {
      refuse("fibre " + std::to_string(fiber) + " has " + std::to_string(segments) +
             " segments, more than " + std::to_string(most_segments) +
             " and not as many as the others");
    }
    append_uint16(bytes, segments);
  }
}

/// Calls visit(fibre, index of the point) for all points.
template <class Visit>
void for_each_point(const FiberAssembly& fibers, const Visit& visit) {
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::size_t i = fibers.offsets()[fiber]; i < fibers.offsets()[fiber + 1]; ++i) {
      visit(fiber, i);
    }
  }
}

std::string encoded(const FiberFile& file) {
  if (file.has_frames || file.frames.size() != 1) {
    refuse("it holds exactly 1 frame without a number, not " + std::to_string(file.frames.size()) +
           (file.has_frames ? " with numbers" : ""));
  }
  const FiberAssembly& fibers = file.frames.front().fibers;
  const bool segments_differ = fibers.fiber_count() > 0 && common_segments(fibers) == 0;
  const bool radii_differ = fibers.radii().size() > 1;
  const std::uint32_t flags =
      POINTS | (segments_differ ? SEGMENTS : 0U) | (radii_differ ? THICKNESS : 0U);
  std::string bytes = header(fibers, flags);
  bytes.reserve(header_size + 2 * fibers.fiber_count() + 16 * fibers.point_count());
  if (segments_differ) {
    append_segments(bytes, fibers);
  }
  for_each_point(fibers, [&](std::size_t fiber, std::size_t i) {
    for (int axis = 0; axis < 3; ++axis) {
      const char name[] = {"xyz"[axis], '\0'};
      append_float32(bytes, single_precision(fibers.points()[i][axis], name, fiber,
                                             i - fibers.offsets()[fiber]));
    }
  });
  if (radii_differ) {
    for_each_point(fibers, [&](std::size_t fiber, std::size_t i) {
      append_float32(bytes, single_precision(2.0 * point_radius(fibers, fiber, i), "the thickness",
                                             fiber, i - fibers.offsets()[fiber]));
    });
  }
  return bytes;
}

}  // namespace

void write_hair(const std::string& path, const FiberFile& file) {
  const std::string bytes = encoded(file);  // a file that cannot be made is not left behind half
  OutputFile output(path);
  output.write(bytes);
  output.close();
}

void write_hair(std::ostream& stream, const FiberFile& file) { stream << encoded(file); }

}  // namespace fiber

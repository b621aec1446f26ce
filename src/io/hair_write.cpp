#include <limits>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/io/bytes.hpp"
#include "src/io/hair_format.hpp"
#include "src/io/one_frame.hpp"

namespace fiber {
namespace {

using namespace hair_format;

[[noreturn]] void refuse(const std::string& reason) { refuse_to_encode(".hair", reason); }

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

Header header_of(const FiberAssembly& fibers, std::uint32_t flags) {
  Header header;
  header.strands = static_cast<std::uint32_t>(fibers.fiber_count());
  header.points = static_cast<std::uint32_t>(fibers.point_count());
  header.flags = flags;
  header.default_segments = common_segments(fibers);
  const bool shared_radius = (flags & THICKNESS) == 0;
  const double thickness = shared_radius ? 2.0 * fibers.radii().front() : 0.0;
  header.default_thickness = single_precision(".hair", thickness, "the thickness", 0, 0);
  return header;
}

void append_segments(std::string& bytes, const FiberAssembly& fibers) {
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const std::uint32_t segments = segments_of(fibers, fiber);
    constexpr std::uint32_t max_segments = std::numeric_limits<std::uint16_t>::max();
    if (segments > max_segments) {
      refuse("fibre " + std::to_string(fiber) + " has " + std::to_string(segments) +
             " segments, more than " + std::to_string(max_segments) +
             " and not as many as the others");
    }
    append_value(bytes, static_cast<std::uint16_t>(segments));
  }
}

std::string encoded(const FiberFile& file) {
  const FiberAssembly& fibers = only_frame(".hair", file).fibers;
  const bool segments_differ = fibers.fiber_count() > 0 && common_segments(fibers) == 0;
  const bool radii_differ = fibers.radius_per() != RadiusPer::ASSEMBLY;
  const std::uint32_t flags =
      POINTS | (segments_differ ? SEGMENTS : 0U) | (radii_differ ? THICKNESS : 0U);
  std::string bytes(signature, sizeof(signature));
  append_value(bytes, header_of(fibers, flags));
  bytes.reserve(bytes.size() + 2 * fibers.fiber_count() + 16 * fibers.point_count());
  if (segments_differ) {
    append_segments(bytes, fibers);
  }
  for_each_point(fibers, [&](std::size_t fiber, std::size_t i) {
    for (int axis = 0; axis < 3; ++axis) {
      const char name[] = {"xyz"[axis], '\0'};
      append_value(bytes, single_precision(".hair", fibers.points()[i][axis], name, fiber,
                                           i - fibers.offsets()[fiber]));
    }
  });
  if (radii_differ) {
    for_each_point(fibers, [&](std::size_t fiber, std::size_t i) {
      append_value(bytes, single_precision(".hair", 2.0 * fibers.radius_at(fiber, i),
                                           "the thickness", fiber, i - fibers.offsets()[fiber]));
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

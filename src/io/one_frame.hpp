#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/io/fiber_file.hpp"
#include "src/io/file_format.hpp"

namespace fiber {

// Files of formats that hold one frame.

/// The bytes of a file.
/// @param format one that holds one frame
/// @throws std::invalid_argument if it cannot hold this
FIBER_PROXIMITY_EXPORT std::string encoded(FileFormat format, const FiberFile& file);

/// Tells, in a sentence each, which parts of a frame, such as names, a format of one frame has no
/// place for.
FIBER_PROXIMITY_EXPORT std::vector<std::string> losses(FileFormat format, const FiberFrame& frame);

// ---- for those that write them; `end` is how names of the format end

/// @throws std::invalid_argument
[[noreturn]] void refuse_to_encode(const char* end, const std::string& reason);

/// @throws std::invalid_argument for anything but one frame without a number
const FiberFrame& only_frame(const char* end, const FiberFile& file);

/// @param what the value is, for the error, with its fibre and its point in that
/// @throws std::invalid_argument if it is beyond single precision
float single_precision(const char* end, double value, const char* what, std::size_t fiber,
                       std::size_t point);

/// Whether a fibre has a radius that is not 0.
bool has_radii(const FiberAssembly& fibers);

/// Calls visit(fibre, index of the point) for all points.
template <class Visit>
void for_each_point(const FiberAssembly& fibers, const Visit& visit) {
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::size_t i = fibers.offsets()[fiber]; i < fibers.offsets()[fiber + 1]; ++i) {
      visit(fiber, i);
    }
  }
}

}  // namespace fiber

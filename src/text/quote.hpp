#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "fiber_proximity/export.hpp"

namespace fiber {

/// A text from outside, fit for one line of an error: control characters and bytes that are not
/// UTF-8 are escaped (\n, \x1B). Of more than `most` bytes, the first three quarters and the last
/// quarter stay, with how many there are between them.
FIBER_PROXIMITY_EXPORT std::string shortened(std::string_view text, std::size_t most = 200);

/// The shortened text between quotes.
FIBER_PROXIMITY_EXPORT std::string quote(std::string_view text);

}  // namespace fiber

#pragma once

#include <string>
#include <string_view>

#include "fiber_proximity/export.hpp"

namespace fiber {

/// Appends a text as a field of CSV (RFC 4180): quoted where it could be taken for anything else,
/// also for a comment or for blanks around a value.
FIBER_PROXIMITY_EXPORT void append_csv_field(std::string& line, std::string_view text);

}  // namespace fiber

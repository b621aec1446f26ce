#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/query/crossing.hpp"

namespace fiber {

/// The header line of crossings as CSV, without the frame.
std::string crossings_csv_header();

/// Appends a line of CSV per crossing, shortest round-trip decimals.
void append_csv(std::string& text, std::optional<std::int64_t> frame,
                const std::vector<Crossing>& crossings);

/// Appends a line with one JSON object: the frame's number, if it has one, and the crossings.
void append_json(std::string& text, std::optional<std::int64_t> frame,
                 const std::vector<Crossing>& crossings);

}  // namespace fiber

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/query/crossings.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {

/// The header line of crossings as CSV, without the frame.
std::string crossings_csv_header();

/// Writes a line of CSV per crossing, shortest round-trip decimals.
void write_csv(TextOutput& output, std::optional<std::int64_t> frame,
               const std::vector<Crossing>& crossings);

/// Writes a line with one JSON object: the frame's number, if it has one, and the crossings.
void write_json(TextOutput& output, std::optional<std::int64_t> frame,
                const std::vector<Crossing>& crossings);

}  // namespace fiber

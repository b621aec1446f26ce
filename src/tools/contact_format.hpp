#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/query/contact.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {

/// The header line of contacts as CSV; `frame` leads where frames have numbers.
std::string csv_header(bool has_frames);

/// Writes a line of CSV per contact, shortest round-trip decimals.
void write_csv(TextOutput& output, std::optional<std::int64_t> frame,
               const std::vector<Contact>& contacts);

/// Writes a line with one JSON object: the frame's number, if it has one, whether the answer is
/// complete, what no pair is closer than (null without a pair), and the contacts.
void write_json(TextOutput& output, std::optional<std::int64_t> frame, const QueryResult& result);

}  // namespace fiber

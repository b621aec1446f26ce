#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/query/contact.hpp"

namespace fiber {

/// The header line of contacts as CSV; `frame` leads where frames have numbers.
std::string csv_header(bool has_frames);

/// Appends a line of CSV per contact, shortest round-trip decimals.
void append_csv(std::string& text, std::optional<std::int64_t> frame,
                const std::vector<Contact>& contacts);

/// Appends a line with one JSON object: the frame's number, if it has one, whether the answer is
/// complete, what no pair is closer than (null without a pair), and the contacts.
void append_json(std::string& text, std::optional<std::int64_t> frame, const QueryResult& result);

}  // namespace fiber

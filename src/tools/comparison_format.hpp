#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "fiber_proximity/compare/comparison.hpp"

namespace fiber {

/// One frame of a file, compared.
struct FrameComparison {
  std::optional<std::int64_t> frame;  ///< if the file numbers its frames
  double update_time = 0.0;           ///< [s] of our engine
  Comparison comparison;
};

/// The header line of comparisons as CSV; `frame` leads where frames have numbers.
std::string comparison_csv_header(bool has_frames);

/// Appends a line of CSV for our engine and one for each style of FCL; disagreements are counted,
/// not listed.
void append_csv(std::string& text, const FrameComparison& frame);

/// Appends a line with one JSON object.
void append_json(std::string& text, const FrameComparison& frame);

/// Appends lines to read: one for our engine, one for each style and for each disagreement.
void append_text(std::string& text, const FrameComparison& frame);

}  // namespace fiber

#pragma once

#include <string>

#include "src/accuracy/accuracy_report.hpp"

namespace fiber {

/// Time against error of all settings as SVG, a panel per question, on logarithmic axes. A setting
/// has one colour and shape throughout. What another one dominates is pale; errors below a
/// nanometre lie at the lower edge, as "exact"; a thin line goes up to what an answer states about
/// its own error. Lines show the tracker's noise and the time from a frame to the next, where they
/// are known.
std::string picture_of(const AccuracyReport& report);

}  // namespace fiber

#pragma once

#include <optional>

#include "fiber_proximity/sim/scene/description.hpp"

namespace fiber {

/// Reads the fibres of a scene, `substeps`, `accuracy` (a number, or one with %) and `real_time`
/// (true): with one of these two, segments of fibres and substeps that the scene does not give are
/// chosen by ResolutionTable: as few as are that accurate, or the most accurate that are estimated
/// to take at most half of the time there is.
/// @param gravity [m/s²]
/// @param scene   with its time step, options and whether it has contacts; gets the fibres and
/// rods,
///                substeps and accuracy
/// @throws std::invalid_argument naming file, line, field and value, and what is allowed; for an
///         accuracy that takes more substeps or segments than there may be, too
void read_resolution(const YamlField& document, double gravity, SimDescription& scene);

}  // namespace fiber

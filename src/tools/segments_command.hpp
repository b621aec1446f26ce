#pragma once

#include "src/tools/command_line.hpp"

namespace fiber {

/// `segments FILE [--kernel K]`: the distance of each pair of segments in a file, with bounds.
void add_segments(CLI::App& app, Command& command);

}  // namespace fiber

#pragma once

#include "src/tools/command_line.hpp"

namespace fiber {

/// `compare FILE`: our engine beside FCL on each frame; DISAGREED if ours is wrong anywhere.
void add_compare(CLI::App& app, Command& command);

}  // namespace fiber

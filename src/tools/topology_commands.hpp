#pragma once

#include "src/tools/command_line.hpp"

namespace fiber {

/// How fibres lie over, around and within each other:
/// `crossings FILE [--direction X,Y,Z] [--eye X,Y,Z]`, `linking FILE` and `writhe FILE [--closed]`.
void add_topology(CLI::App& app, Command& command);

}  // namespace fiber

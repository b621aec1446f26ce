#pragma once

#include "src/tools/command_line.hpp"

namespace fiber {

/// `sweep FILE --margin M [--type all|first]`: contacts between the frames of a file, with the time
/// at which each begins.
void add_sweep(CLI::App& app, Command& command);

}  // namespace fiber

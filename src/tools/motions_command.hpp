#pragma once

#include "src/tools/command_line.hpp"

namespace fiber {

/// `motions FILE [--radius R] [--margin M] [--tolerance T]`: when each pair of moving capsules in a
/// file first touches, with bounds.
void add_motions(CLI::App& app, Command& command);

}  // namespace fiber

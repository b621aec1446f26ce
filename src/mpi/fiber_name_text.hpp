#pragma once

#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/mpi/communicator.hpp"

namespace fiber {

// Names of fibres as one text: sent to other ranks, and in a file.

/// Each name with a line's end after it; nothing of fibres that are called by their numbers.
std::vector<char> text_of_names(const FiberNames& names);

/// @throws std::runtime_error, std::invalid_argument for what is no such text
FiberNames names_in_text(const std::vector<char>& text);

/// The names that rank 0 has, for every rank. Collective.
FiberNames broadcast_names(const Communicator& ranks, const FiberNames& names);

}  // namespace fiber

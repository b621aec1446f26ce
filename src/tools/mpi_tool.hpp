#pragma once

#include <cstdint>
#include <string>

#include "src/mpi/communicator.hpp"
#include "src/tools/command_line.hpp"
#include "src/tools/progress.hpp"

namespace fiber {

/// run_tool() on every rank of MPI, from its start to its end. Rank 0 alone writes to stdout and
/// stderr; commands see to it that all ranks throw what one does.
int run_mpi_tool(const char* name, const char* description, const Setup& setup, int argc,
                 char** argv);

/// Shows the progress of rank 0, if its stderr ends in a terminal, and nothing of the others.
Progress rank_progress(const Communicator& ranks);

/// Shows a bar, unless there is only one step.
/// @param what the steps are
void show_done(Progress& progress, std::uint64_t done, std::uint64_t all, const std::string& what);

/// @throws std::invalid_argument on all ranks if both names are of the same file
void require_other_file(const Communicator& ranks, const std::string& in, const std::string& out);

}  // namespace fiber

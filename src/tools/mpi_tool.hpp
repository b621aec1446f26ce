#pragma once

#include <functional>

#include "src/mpi/communicator.hpp"
#include "src/tools/command_line.hpp"

namespace fiber {

/// run_tool() on every rank of MPI, from its start to its end. Rank 0 alone writes to stdout and
/// stderr; commands see to it that all ranks throw what one does.
int run_mpi_tool(const char* name, const char* description, const Setup& setup, int argc,
                 char** argv);

/// Does on rank 0 what may go wrong there. Collective.
/// @throws std::invalid_argument on all ranks if it does
void on_first_rank(const Communicator& ranks, const std::function<void()>& work);

}  // namespace fiber

#pragma once

#include <string>

#include "fiber_proximity/query/options.hpp"
#include "src/tools/command_line.hpp"
#include "src/tools/query_options.hpp"

namespace fiber {

// The subcommands of fiber_query_mpi that have a source of their own, and what several of them
// share.

/// `check CANDIDATES [--environment WORLD] [--margin M]`: which of many candidates could be there.
void add_check_mpi(CLI::App& app, Command& command);

/// `convert IN OUT [--radius R] [--resume]`: a file of fibres in another format.
void add_convert(CLI::App& app, Command& command);

/// `sweep FILE --margin M [--type all|first] [--out CONTACTS.csv]`: contacts between the frames of
/// a file, with the time at which each begins.
void add_sweep_mpi(CLI::App& app, Command& command);

/// File, radius and threads, of which a rank has one unless it is told otherwise: ranks share a
/// machine.
void add_rank_options(CLI::App& app, FiberRequest& request);

constexpr const char* rank_threads_help =
    "most threads that each rank uses, 0 for as many as there are cores";

/// @param ends what the names of files that can be written end in
void add_out_option(CLI::App& app, std::string& out, const std::string& ends);

/// Which pairs a query asks about, and how, as a run that is gone on with is compared by.
std::string text_of_pairs(const QueryOptions& query);

}  // namespace fiber

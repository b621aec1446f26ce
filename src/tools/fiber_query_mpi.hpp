#pragma once

#include <string>

#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/query/options.hpp"
#include "src/tools/command_line.hpp"

namespace fiber {

/// A file of fibres, and the engine of each rank that answers questions about them.
struct RankRequest {
  std::string file;
  double radius = 0.0;                   // [m]
  EngineOptions engine_options{1, 0.0};  // one thread: ranks share a machine
};

void add_rank_options(CLI::App& app, RankRequest& request);

/// Which pairs a query asks about, and how, as a run that is gone on with is compared by.
std::string text_of_pairs(const QueryOptions& query);

// The subcommands of fiber_query_mpi that have a source of their own.

/// `check CANDIDATES [--environment WORLD] [--margin M]`: which of many candidates could be there.
void add_check(CLI::App& app, Command& command);

/// `convert IN OUT [--radius R] [--resume]`: a file of fibres in another format.
void add_convert(CLI::App& app, Command& command);

/// `sweep FILE --margin M [--type all|first] [--out CONTACTS.csv]`: contacts between the frames of
/// a file, with the time at which each begins.
void add_sweep_mpi(CLI::App& app, Command& command);

}  // namespace fiber

#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "src/tools/command_line.hpp"

namespace fiber {

// The options that commands of fiber_query and of fiber_query_mpi share.

constexpr const char* format_help =
    "of the output; json: one object per frame, in which a fibre's name is a number if it is whole";

/// A file of fibres, and how engines work that answer questions about them.
struct FiberRequest {
  std::string file;
  ReadOptions reading;
  EngineOptions engine_options;
};

/// FILE, how it is read, and the number of threads.
/// @param file    help for the file
/// @param threads help for the number of threads
void add_fiber_options(CLI::App& app, FiberRequest& request, const std::string& file,
                       const std::string& threads);

/// Adds `--radius` and `--skip-single-points`.
void add_read_options(CLI::App& app, ReadOptions& reading);

/// The part of them that an answer depends on, as the runs of files that can be gone on with are
/// named.
std::string text_of(const ReadOptions& reading);

void add_threads_option(CLI::App& app, std::uint32_t& threads, const std::string& help);

/// Adds `--kernel`, which says how distances are computed.
void add_kernel_option(CLI::App& app, Kernel& kernel);

/// Which segments of one fibre are pairs.
void add_neighbour_options(CLI::App& app, std::optional<std::uint32_t>& skip,
                           std::optional<double>& skip_length);

/// A question about pairs of segments, as a subcommand asks it.
struct PairQuery {
  const char* name;
  const char* description;
  QueryType type;
  double default_margin;  // [m]
};

/// All of them: `contacts`, `closest`, `first` and `fiber_pairs`.
const std::array<PairQuery, 4>& pair_queries();

/// The options of a question about pairs, as they are read.
struct PairRequest {
  QueryOptions options;
  std::optional<double> margin;  // [m]
};

/// Margin, neighbours, kernel, tolerances and deadline.
void add_pair_options(CLI::App& app, const PairQuery& query, PairRequest& request);

/// The question once all options are read.
/// @throws std::invalid_argument for options that do not validate
QueryOptions options_of(const PairQuery& query, const PairRequest& request);

/// The options of `sweep`: a question about the motions from frame to frame.
struct SweepRequest : FiberRequest {
  MotionOptions motion;
  bool new_only = false;
};

/// The subcommand `sweep` without what it does: margin, tolerances, type and neighbours.
CLI::App* add_sweep_options(CLI::App& app, SweepRequest& request);

}  // namespace fiber

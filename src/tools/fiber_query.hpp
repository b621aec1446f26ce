#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "src/tools/command_line.hpp"

namespace fiber {

// The subcommands of fiber_query that have a source of their own, and the options that several
// have.

/// `segments FILE [--kernel K]`: the distance of each pair of segments in a file, with bounds.
void add_segments(CLI::App& app, Command& command);

/// `motions FILE [--radius R] [--margin M] [--tolerance T]`: when each pair of moving capsules in a
/// file first touches, with bounds.
void add_motions(CLI::App& app, Command& command);

/// `sweep FILE --margin M [--type all|first]`: contacts between the frames of a file, with the time
/// at which each begins.
void add_sweep(CLI::App& app, Command& command);

/// `compare FILE`: our engine beside FCL on each frame; DISAGREED if ours is wrong anywhere.
void add_compare(CLI::App& app, Command& command);

/// How fibres lie over, around and within each other:
/// `crossings FILE [--direction X,Y,Z] [--eye X,Y,Z]`, `linking FILE` and `writhe FILE [--closed]`.
void add_topology(CLI::App& app, Command& command);

/// What is said of a file of fibres, and of what is written.
constexpr const char* file_help =
    "fibre file: .hair, or CSV with the columns x, y, z and where there are any frame, fiber (a "
    "name, which answers repeat) and radius";
constexpr const char* format_help =
    "of the output; json: one object per frame, in which a fibre's name is a number if it is whole";

/// A file of fibres, and who answers questions about them.
struct FiberRequest {
  std::string file;
  double radius = 0.0;  // [m]
  std::string engine = "run_tree";
  EngineOptions engine_options;
};

/// @param threads what is said of the number of threads
void add_fiber_options(
    CLI::App& app, FiberRequest& request,
    const std::string& threads = "most threads to use, 0 for as many as there are cores");

/// Adds `--kernel`, which says how distances are computed.
void add_kernel_option(CLI::App& app, Kernel& kernel);

/// A question about pairs of segments, as a subcommand asks it.
struct PairQuery {
  const char* name;
  const char* description;
  QueryType type;
  double default_margin;  // [m]
};

/// All there are: `contacts`, `closest`, `first` and `fiber_pairs`.
const std::array<PairQuery, 4>& pair_queries();

/// What is asked about pairs, as options are read.
struct PairRequest {
  QueryOptions options;
  std::optional<double> margin;  // [m]
};

/// Margin, neighbours, kernel, tolerances and deadline.
void add_pair_options(CLI::App& app, const PairQuery& query, PairRequest& request);

/// What is asked once all options are read.
/// @throws std::invalid_argument for options that do not validate
QueryOptions options_of(const PairQuery& query, const PairRequest& request);

/// What is asked about the motions from frame to frame.
struct SweepRequest {
  MotionOptions motion;
  bool new_only = false;
};

constexpr const char* sweep_columns =
    "frame,fiber_a,segment_a,fiber_b,segment_b,time_lower,time_upper\n";

/// Margin, tolerances, type and neighbours.
void add_sweep_options(CLI::App& app, SweepRequest& request);

/// Which segments of one fibre are pairs.
void add_neighbour_options(CLI::App& app, std::optional<std::uint32_t>& skip,
                           std::optional<double>& skip_length);

}  // namespace fiber

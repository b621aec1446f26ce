#pragma once

#include <functional>
#include <string>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/tools/command_line.hpp"
#include "src/tools/query_options.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {

// The subcommands of fiber_query that have a source of their own, and what several of them share.

/// `accuracy FILE [--margin M] [--noise N] [--picture OUT.svg]`: what each setting costs and errs
/// on the frames of a file, and which one to take; DISAGREED if an answer's bounds exclude the
/// truth.
/// @param engines to be compared unless others are named
void add_accuracy(CLI::App& app, Command& command, const std::vector<std::string>& engines);

/// `check CANDIDATES [--environment WORLD] [--margin M]`: which of many candidates could be there.
void add_check(CLI::App& app, Command& command);

/// `compare FILE`: our engine beside FCL on each frame; DISAGREED if ours is wrong anywhere.
void add_compare(CLI::App& app, Command& command);

/// `motions FILE [--radius R] [--margin M] [--tolerance T]`: when each pair of moving capsules in a
/// file first touches, with bounds.
void add_motions(CLI::App& app, Command& command);

/// `segments FILE [--kernel K]`: the distance of each pair of segments in a file, with bounds.
void add_segments(CLI::App& app, Command& command);

/// `sweep FILE --margin M [--type all|first]`: contacts between the frames of a file, with the time
/// at which each begins.
void add_sweep(CLI::App& app, Command& command);

/// How fibres lie over, around and within each other:
/// `crossings FILE [--direction X,Y,Z] [--eye X,Y,Z]`, `linking FILE` and `writhe FILE [--closed]`.
void add_topology(CLI::App& app, Command& command);

constexpr const char* file_help =
    "fibre file: .hair, .npz, .swc, .tck, .trk, .vtk or .vtp, or CSV with the columns x, y, z and "
    "where there "
    "are any frame, fiber (a "
    "name, which answers repeat) and radius";
constexpr const char* threads_help = "most threads to use, 0 for as many as there are cores";

/// The engine that answers.
void add_engine_option(CLI::App& app, std::string& engine);

/// Reads a file of fibres, and writes to stdout what is to be said of each frame.
/// @param columns of CSV, after the number of the frame; "" for another format
ExitCode write_frames(const std::string& path, const ReadOptions& reading,
                      const std::string& columns,
                      const std::function<void(const FrameNumber& number, const FiberFrame& frame,
                                               TextOutput& output)>& write);

}  // namespace fiber

#pragma once

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "src/text/join.hpp"

namespace fiber {

/// Exit codes of all tools.
enum ExitCode { SUCCEEDED = 0, DISAGREED = 1, REFUSED = 2 };

/// The work of a tool once its command line is parsed.
using Command = std::function<ExitCode()>;

/// Declares a tool's options and sets the command; one with subcommands has each of them set it
/// when it is chosen.
using Setup = std::function<void(CLI::App& app, Command& command)>;

/// A whole tool, for main to return. Whatever is wrong with the command line, a file or a value
/// becomes one line on stderr and REFUSED; so does output that cannot be written.
int run_tool(const char* name, const char* description, const Setup& setup, int argc,
             const char* const* argv);

/// Accepts whole numbers from `min`.
CLI::Validator whole_number(std::uint64_t min);

/// Accepts finite numbers from `min`.
CLI::Validator finite_number(double min);

/// Accepts lengths [m] from 0 to FiberAssembly::max_coordinate.
CLI::Validator length();

/// Accepts lengths [m] from 0 to FiberAssembly::max_coordinate, and infinity.
CLI::Validator length_or_infinity();

/// The vector of an option's text X,Y,Z.
/// @throws CLI::ValidationError naming the option, the text and what is allowed
Eigen::Vector3d parse_vector(const std::string& option, const std::string& text);

}  // namespace fiber

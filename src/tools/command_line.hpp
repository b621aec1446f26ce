#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace fiber {

/// Exit codes of all tools.
enum ExitCode { SUCCEEDED = 0, DISAGREED = 1, REFUSED = 2 };

/// Accepts whole numbers from `least`.
CLI::Validator whole_number(std::uint64_t least);

/// The names with commas between them.
std::string listed(const std::vector<std::string>& names);

/// Parses the command line and runs the tool. Whatever is wrong with the command line, a file or a
/// value becomes one line on stderr and REFUSED; so does output that cannot be written.
/// @param run called once the command line is parsed
/// @return the exit code for main
int run_tool(CLI::App& app, int argc, const char* const* argv,
             const std::function<ExitCode()>& run);

}  // namespace fiber

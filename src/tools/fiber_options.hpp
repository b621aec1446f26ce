#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "fiber_proximity/query/engine.hpp"
#include "src/tools/command_line.hpp"

namespace fiber {

/// A file of fibres, and who answers questions about them.
struct FiberRequest {
  std::string file;
  double radius = 0.0;  // [m]
  std::string engine = "run_tree";
  EngineOptions engine_options;
};

void add_fiber_options(CLI::App& app, FiberRequest& request);

/// How distances are computed. `fast`, of versions before this one, is taken as robust, with a
/// warning.
void add_kernel_option(CLI::App& app, Kernel& kernel);

/// Which segments of one fibre are pairs.
void add_neighbour_options(CLI::App& app, std::optional<std::uint32_t>& skip,
                           std::optional<double>& skip_length);

}  // namespace fiber

#pragma once

#include <vector>

#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/query/options.hpp"
#include "src/mpi/plan.hpp"
#include "src/tools/command_line.hpp"

namespace fiber {

/// `--plan P [--bandwidth B] [--latency L] [--adopted]`.
struct PlanRequest {
  int parts = 0;  ///< 0: no plan is wanted
  Network network;
};

/// @param what is planned, in the help of `--plan`
/// @return the option `--plan`
CLI::Option* add_plan_options(CLI::App& app, PlanRequest& request, const std::string& what);

/// Writes least, mean and largest of what is predicted of parts to stdout, as CSV.
void write_plan(const std::vector<PlannedPart>& parts);

}  // namespace fiber

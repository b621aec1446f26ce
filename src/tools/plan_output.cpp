#include "src/tools/plan_output.hpp"

#include <algorithm>
#include <iostream>
#include <string>
#include <utility>

#include "src/tools/text_output.hpp"

namespace fiber {
namespace {

constexpr int most_planned_parts = 1'000'000;

}  // namespace

CLI::Option* add_plan_options(CLI::App& app, PlanRequest& request, const std::string& what) {
  CLI::Option* const plan =
      app.add_option("--plan", request.parts,
                     "write as CSV what each of so many ranks would hold and take " + what)
          ->check(CLI::Range(1, most_planned_parts));
  app.add_option("--bandwidth", request.network.bandwidth, "of the plan's ranks [byte/s]")
      ->check(finite_number(1.0))
      ->needs(plan)
      ->capture_default_str();
  app.add_option("--latency", request.network.latency, "of a message between them [s]")
      ->check(finite_number(0.0))
      ->needs(plan)
      ->capture_default_str();
  app.add_flag("--adopted", request.network.is_adopted,
               "the plan's ranks bring what they hold, so that only halos travel")
      ->needs(plan);
  return plan;
}

void write_plan(const std::vector<PlannedPart>& parts) {
  TextOutput output(std::cout);
  output.write("quantity,min,mean,max\n");
  const auto write = [&](const std::string& name, const auto& value_of) {
    double least = value_of(parts.front());
    double most = least;
    double sum = 0.0;
    for (const PlannedPart& part : parts) {
      const double value = value_of(part);
      least = std::min(least, value);
      most = std::max(most, value);
      sum += value;
    }
    output.write_row(name, least, sum / static_cast<double>(parts.size()), most);
  };
  write("segments", [](const PlannedPart& part) { return part.segments; });
  write("halo_segments", [](const PlannedPart& part) { return part.halo_segments; });
  write("halo_share",
        [](const PlannedPart& part) { return part.halo_segments / std::max(1.0, part.segments); });
  write("neighbours", [](const PlannedPart& part) { return part.neighbours; });
  write("bytes", [](const PlannedPart& part) { return part.bytes; });
  write("seconds", [](const PlannedPart& part) { return part.seconds; });
  write("efficiency", [](const PlannedPart& part) { return part.efficiency; });
  output.flush();
}

}  // namespace fiber

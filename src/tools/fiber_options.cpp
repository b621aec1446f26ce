#include "src/tools/fiber_options.hpp"

#include <iostream>

namespace fiber {

void add_fiber_options(CLI::App& app, FiberRequest& request) {
  app.add_option("FILE", request.file, "fibre file (.csv or .hair)")->required();
  app.add_option("--engine", request.engine, "one of " + join(engine_names()))
      ->capture_default_str();
  app.add_option("--radius", request.radius, "of all fibres, if the file has no radii [m]")
      ->capture_default_str();
  app.add_option("--threads", request.engine_options.threads,
                 "most threads to use, 0 for as many as there are cores")
      ->check(whole_number(0))
      ->capture_default_str();
}

void add_kernel_option(CLI::App& app, Kernel& kernel) {
  app.add_option_function<std::string>(
         "--kernel",
         [&kernel](const std::string& name) {
           const std::string current = current_kernel_name(name);
           if (current != name) {
             std::cerr << "warning: --kernel " << name << " saved no time and is gone: " << current
                       << " is used\n";
           }
           kernel = kernel_from_name(current);
         },
         "one of " + join(kernel_names()))
      ->default_str("robust");
}

void add_neighbour_options(CLI::App& app, std::optional<std::uint32_t>& skip,
                           std::optional<double>& skip_length) {
  app.add_option("--neighbour-skip", skip,
                 "segments of a fibre whose indices differ by at most this are no pair; without "
                 "this and the next option, those are that the fibre makes a loop between");
  app.add_option("--neighbour-skip-length", skip_length,
                 "segments of a fibre with less than this between them are no pair [m]; with one "
                 "of the two given, the other is 1 or 0 m, and no loop is needed");
}

}  // namespace fiber

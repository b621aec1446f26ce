// Options that tools about pairs of segments share.
#include <iostream>

#include "src/tools/fiber_query.hpp"

namespace fiber {

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

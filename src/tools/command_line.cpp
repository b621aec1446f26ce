#include "command_line.hpp"

#include <cmath>
#include <exception>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/io/number.hpp"

namespace fiber {
namespace {

ExitCode refuse(const char* tool, const char* reason) {
  std::cerr << tool << ": " << reason << '\n';
  return REFUSED;
}

std::vector<std::string> subcommands(CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* subcommand : app.get_subcommands([](CLI::App*) { return true; })) {
    names.push_back(subcommand->get_name());
  }
  return names;
}

ExitCode parse_and_run(CLI::App& app, const Setup& setup, int argc, const char* const* argv) {
  Command command;
  setup(app, command);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) {
      throw;
    }
    app.exit(error);  // prints the help that was asked for
    return SUCCEEDED;
  }
  if (!command) {
    throw std::invalid_argument("a subcommand is needed: " + listed(subcommands(app)));
  }
  return command();
}

}  // namespace

int run_tool(const char* name, const char* description, const Setup& setup, int argc,
             const char* const* argv) {
  try {
    CLI::App app(description, name);
    const ExitCode code = parse_and_run(app, setup, argc, argv);
    std::cout.flush();
    return std::cout ? code : refuse(name, "the output cannot be written");
  } catch (const std::exception& error) {
    return refuse(name, error.what());
  }
}

CLI::Validator whole_number(std::uint64_t least) {
  const std::string range = "from " + std::to_string(least);
  return {[range, least](std::string& text) -> std::string {
            const auto value = parse_number<std::uint64_t>(text);
            return value && *value >= least ? "" : "'" + text + "' must be a whole number " + range;
          },
          range};
}

CLI::Validator finite_number(double least) {
  std::string range = "from ";
  append_number(range, least);
  return {[range, least](std::string& text) -> std::string {
            const auto value = parse_number<double>(text);
            return value && std::isfinite(*value) && *value >= least
                       ? ""
                       : "'" + text + "' must be a finite number " + range;
          },
          range};
}

Eigen::Vector3d parse_vector(const std::string& option, const std::string& text) {
  Eigen::Vector3d vector;
  std::istringstream stream(text);
  std::string coordinate;
  for (double& value : vector) {
    std::getline(stream, coordinate, ',');
    value = parse_number<double>(coordinate).value_or(std::nan(""));
    coordinate.clear();
  }
  if (!stream.eof() || !vector.unaryExpr(&FiberAssembly::is_valid_coordinate).all()) {
    throw CLI::ValidationError(
        option, "'" + text + "' must be three numbers X,Y,Z; " + FiberAssembly::coordinate_rule);
  }
  return vector;
}

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) {
    list += (list.empty() ? "" : ", ") + name;
  }
  return list;
}

}  // namespace fiber

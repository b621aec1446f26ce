#include "src/tools/command_line.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <iostream>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/io/number.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

// [byte] Our errors shorten what they repeat, but for the path of a file; those of CLI11 do not.
constexpr std::size_t longest_error = 6'000;
constexpr std::size_t longest_parse_error = 600;

ExitCode refuse(const char* tool, const std::string& reason) {
  std::cerr << tool << ": " << shortened(reason, longest_error) << '\n';
  return REFUSED;
}

std::vector<std::string> subcommands(CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* subcommand : app.get_subcommands([](CLI::App*) { return true; })) {
    names.push_back(subcommand->get_name());
  }
  return names;
}

/// Refuses what CLI11 takes for a number and is none: nothing at all would be 0, what is beyond the
/// type's range infinity. `inf` is a number.
std::string refuse_no_number(const std::string& text) {
  return parse_number<double>(text) ? "" : quote(text) + " must be a number";
}

/// Every option with a number as its value has it checked, whoever declared it.
void check_numbers(CLI::App& app) {
  for (CLI::Option* option : app.get_options()) {
    const std::string type = option->get_type_name();
    for (const char* number : {"FLOAT", "INT", "UINT"}) {
      if (type.rfind(number, 0) == 0) {
        option->check(refuse_no_number);
      }
    }
  }
  for (CLI::App* subcommand : app.get_subcommands([](CLI::App*) { return true; })) {
    check_numbers(*subcommand);
  }
}

/// Accepts numbers of a kind and range for which is_allowed(number) holds.
template <class Number, class IsAllowed>
CLI::Validator number_of(const std::string& kind, const std::string& range,
                         const IsAllowed& is_allowed) {
  return {[=](std::string& text) -> std::string {
            const auto value = parse_number<Number>(text);
            return value && is_allowed(*value) ? ""
                                               : quote(text) + " must be " + kind + ' ' + range;
          },
          range};
}

std::string length_range() { return "from 0 to " + text_of(FiberAssembly::max_coordinate); }

/// The first argument, if it stands where a subcommand should and is none.
std::optional<std::string> unknown_subcommand(const std::vector<std::string>& known, int argc,
                                              const char* const* argv) {
  if (known.empty() || argc < 2 || argv[1][0] == '-' ||
      std::find(known.begin(), known.end(), argv[1]) != known.end()) {
    return std::nullopt;
  }
  return argv[1];
}

ExitCode parse_and_run(CLI::App& app, const Setup& setup, int argc, const char* const* argv) {
  Command command;
  setup(app, command);
  check_numbers(app);
  const std::vector<std::string> known = subcommands(app);
  if (const std::optional<std::string> unknown = unknown_subcommand(known, argc, argv)) {
    throw std::invalid_argument("unknown subcommand " + quote(*unknown) +
                                ", known are: " + join(known));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) {
      throw std::invalid_argument(shortened(error.what(), longest_parse_error));
    }
    app.exit(error);  // prints the help that was asked for
    return SUCCEEDED;
  }
  if (!command) {
    throw std::invalid_argument("a subcommand is needed: " + join(known));
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

CLI::Validator whole_number(std::uint64_t min) {
  return number_of<std::uint64_t>("a whole number", "from " + std::to_string(min),
                                  [min](std::uint64_t value) { return value >= min; });
}

CLI::Validator finite_number(double min) {
  return number_of<double>("a finite number", "from " + text_of(min),
                           [min](double value) { return std::isfinite(value) && value >= min; });
}

CLI::Validator length() {
  return number_of<double>("a number", length_range(), &FiberAssembly::is_valid_radius);
}

CLI::Validator length_or_infinity() {
  return number_of<double>("a number", length_range() + ", or inf", [](double value) {
    return FiberAssembly::is_valid_radius(value) ||
           value == std::numeric_limits<double>::infinity();
  });
}

Eigen::Vector3d parse_vector(const std::string& option, const std::string& text) {
  Eigen::Vector3d vector;
  std::istringstream stream(text);
  std::string coordinate;
  for (Eigen::Index i = 0; i < 3; ++i) {
    std::getline(stream, coordinate, ',');
    vector[i] = parse_number<double>(coordinate).value_or(std::nan(""));
    coordinate.clear();
  }
  if (!stream.eof() || !vector.unaryExpr(&FiberAssembly::is_valid_coordinate).all()) {
    throw CLI::ValidationError(
        option, quote(text) + " must be three numbers X,Y,Z; " + FiberAssembly::coordinate_rule);
  }
  return vector;
}

}  // namespace fiber

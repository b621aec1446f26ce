#include "command_line.hpp"

#include <exception>
#include <iostream>

#include "fiber_proximity/io/number.hpp"

namespace fiber {
namespace {

ExitCode refuse(const CLI::App& app, const std::string& reason) {
  std::cerr << app.get_name() << ": " << reason << '\n';
  return REFUSED;
}

}  // namespace

CLI::Validator whole_number(std::uint64_t least) {
  const std::string range = "from " + std::to_string(least);
  return {[range, least](std::string& text) -> std::string {
            const auto value = parse_number<std::uint64_t>(text);
            return value && *value >= least ? "" : "'" + text + "' must be a whole number " + range;
          },
          range};
}

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) {
    list += (list.empty() ? "" : ", ") + name;
  }
  return list;
}

int run_tool(CLI::App& app, int argc, const char* const* argv,
             const std::function<ExitCode()>& run) {
  try {
    app.parse(argc, argv);
    const ExitCode code = run();
    std::cout.flush();
    return std::cout ? code : refuse(app, "the output cannot be written");
  } catch (const CLI::ParseError& error) {
    // --help arrives as an exception, too.
    return error.get_exit_code() == 0 ? app.exit(error) : refuse(app, error.what());
  } catch (const std::exception& error) {
    return refuse(app, error.what());
  }
}

}  // namespace fiber

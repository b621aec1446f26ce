#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "src/tools/command_line.hpp"

namespace fiber {

/// An option whose help names its default.
template <class Value>
void add_value(CLI::App& app, const std::string& name, Value& value, const std::string& meaning,
               const CLI::Validator& check = {}) {
  app.add_option(name, value, meaning)->check(check)->capture_default_str();
}

/// An option of several values, with commas between them.
template <class Value>
void add_values(CLI::App& app, const std::string& name, std::vector<Value>& values,
                const std::string& meaning, const CLI::Validator& check = {}) {
  app.add_option(name, values, meaning)->delimiter(',')->check(check)->capture_default_str();
}

/// An option of several names, by default all of them.
inline CLI::Option* add_names(CLI::App& app, const std::string& name,
                              std::vector<std::string>& values, const std::string& meaning) {
  return app.add_option(name, values, meaning)->delimiter(',')->default_str("all");
}

/// An option for a whole number.
template <class Count>
void add_count(CLI::App& app, const std::string& name, Count& value, const std::string& meaning,
               std::uint64_t min = 1) {
  add_value(app, name, value, meaning, whole_number(min));
}

/// A subcommand; run(request) is what it does.
template <class Request>
CLI::App* add_subcommand(CLI::App& app, Command& command, const std::string& name,
                         const std::string& description, const std::shared_ptr<Request>& request,
                         ExitCode (*run)(const Request&)) {
  CLI::App* const subcommand = app.add_subcommand(name, description);
  subcommand->callback(
      [&command, request, run] { command = [request, run] { return run(*request); }; });
  return subcommand;
}

}  // namespace fiber

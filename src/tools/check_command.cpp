// `fiber_query check`: which of many candidates could be there.
#include <algorithm>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/tools/candidate_checker.hpp"
#include "src/tools/fiber_query.hpp"
#include "src/tools/read_input.hpp"

namespace fiber {
namespace {

ExitCode run_check(const CheckRequest& request) {
  std::optional<FiberFrame> fibers;
  if (!request.fibers.empty()) {
    FiberFile file = read_input("fiber_query", request.fibers, request.reading);
    if (file.frames.empty()) {
      throw FileError(request.fibers, "has no fibres");
    }
    fibers = std::move(file.frames.front());
  }
  CandidateChecker checker(request, std::move(fibers));
  FiberFile file = read_input("fiber_query", request.file, request.reading);
  TextOutput output(std::cout);
  output.write(check_header(file.has_frames));
  for (auto begin = file.frames.begin(); begin != file.frames.end();) {
    const auto count = std::min<std::ptrdiff_t>(candidates_at_once, file.frames.end() - begin);
    checker.check({std::move_iterator(begin), std::move_iterator(begin + count)}, file.has_frames,
                  output);
    begin += count;
  }
  output.flush();
  return SUCCEEDED;
}

}  // namespace

void add_check(CLI::App& app, Command& command) {
  const auto request = std::make_shared<CheckRequest>();
  CLI::App* const check =
      app.add_subcommand("check", "which candidates could be there, and what the others touch");
  add_check_options(*check, *request, "fibre file (.csv or .hair), each frame a candidate",
                    threads_help);
  check->callback([&command, request] {
    finish_check_options(*request);
    command = [request] { return run_check(*request); };
  });
}

}  // namespace fiber

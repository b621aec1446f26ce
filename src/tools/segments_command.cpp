#include "segments_command.hpp"

#include <iostream>
#include <memory>
#include <string>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "fiber_proximity/io/number.hpp"
#include "fiber_proximity/io/segment_pairs.hpp"

namespace fiber {
namespace {

struct Request {
  std::string file;
  Kernel kernel = Kernel::ROBUST;
};

void append_csv(std::string& text, const SegmentDistance& nearest) {
  append_number(text, nearest.distance);
  for (const double value : {nearest.lower(), nearest.upper(), nearest.s, nearest.t}) {
    text += ',';
    append_number(text, value);
  }
  text += '\n';
}

ExitCode run(const Request& request) {
  std::string text = "distance,lower,upper,s,t\n";
  for (const auto& [p0, p1, q0, q1] : read_segment_pairs(request.file)) {
    append_csv(text, segment_distance(request.kernel, p0, p1, q0, q1));
  }
  std::cout << text;
  return SUCCEEDED;
}

}  // namespace

void add_segments(CLI::App& app, Command& command) {
  CLI::App* segments = app.add_subcommand(
      "segments", "the distance of each pair of segments, and bounds the true one lies between");
  const auto request = std::make_shared<Request>();
  segments
      ->add_option("FILE", request->file,
                   "a pair per line: [name,] and the coordinates of p0, p1, q0 and q1 [m]")
      ->required();
  segments
      ->add_option_function<std::string>(
          "--kernel",
          [request](const std::string& name) { request->kernel = kernel_from_name(name); },
          "one of " + listed(kernel_names()))
      ->default_str("robust");
  segments->callback([&command, request] { command = [request] { return run(*request); }; });
}

}  // namespace fiber

#include "src/tools/segments_command.hpp"

#include <iostream>
#include <memory>
#include <string>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "src/io/number.hpp"
#include "src/io/segment_pairs.hpp"
#include "src/tools/fiber_options.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {
namespace {

struct SegmentsRequest {
  std::string file;
  Kernel kernel = Kernel::ROBUST;
};

void write_csv(TextOutput& output, const SegmentDistance& nearest) {
  std::string& text = output.text();
  append_number(text, nearest.distance);
  for (const double value : {nearest.lower(), nearest.upper(), nearest.s, nearest.t}) {
    text += ',';
    append_number(text, value);
  }
  text += '\n';
  output.flush_if_long();
}

ExitCode run(const SegmentsRequest& request) {
  TextOutput output(std::cout);
  output.text() = "distance,lower,upper,s,t\n";
  for (const auto& [p0, p1, q0, q1] : read_segment_pairs(request.file)) {
    write_csv(output, segment_distance(request.kernel, p0, p1, q0, q1));
  }
  output.flush();
  return SUCCEEDED;
}

}  // namespace

void add_segments(CLI::App& app, Command& command) {
  CLI::App* segments = app.add_subcommand(
      "segments", "the distance of each pair of segments, and bounds the true one lies between");
  const auto request = std::make_shared<SegmentsRequest>();
  segments
      ->add_option("FILE", request->file,
                   "a pair per line: [name,] and the coordinates of p0, p1, q0 and q1 [m]")
      ->required();
  add_kernel_option(*segments, request->kernel);
  segments->callback([&command, request] { command = [request] { return run(*request); }; });
}

}  // namespace fiber

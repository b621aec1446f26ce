// The subcommands of fiber_query about pairs of segments in a file, at rest and in motion.
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "fiber_proximity/geometry/segment_distance.hpp"
#include "src/io/segment_file.hpp"
#include "src/text/csv_field.hpp"
#include "src/tools/fiber_query.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {
namespace {

struct SegmentsRequest {
  std::string file;
  Kernel kernel = Kernel::ROBUST;
};

ExitCode run(const SegmentsRequest& request) {
  const std::vector<SegmentPair> pairs = read_segment_pairs(request.file);
  const bool has_names = std::any_of(pairs.begin(), pairs.end(),
                                     [](const SegmentPair& pair) { return !pair.name.empty(); });
  TextOutput output(std::cout);
  output.write(std::string(has_names ? "name," : "") + "distance,lower,upper,s,t\n");
  std::string name;
  for (const SegmentPair& pair : pairs) {
    if (has_names) {
      name.clear();
      if (!pair.name.empty()) {
        append_csv_field(name, pair.name);
      }
      output.write(name + ',');
    }
    const SegmentDistance nearest =
        segment_distance(request.kernel, pair.p0, pair.p1, pair.q0, pair.q1);
    output.write_row(nearest.distance, nearest.lower(), nearest.upper(), nearest.s, nearest.t);
  }
  output.flush();
  return SUCCEEDED;
}

struct MotionsRequest {
  std::string file;
  double radius = 0.0;      // [m] of each capsule
  double margin = 0.0;      // [m]
  double tolerance = 1e-6;  // [m]
};

std::vector<ContactTime> contact_times_of(const std::vector<MovingSegmentPair>& pairs,
                                          const ContactLimit& limit, double tolerance) {
  std::vector<SegmentMotions> motions;
  motions.reserve(pairs.size());
  for (const MovingSegmentPair& pair : pairs) {
    motions.push_back({pair.a_before, pair.a_after, pair.b_before, pair.b_after, limit});
  }
  std::vector<ContactTime> times(motions.size());
  contact_times(motions.data(), motions.size(), tolerance, times.data());
  return times;
}

ExitCode run(const MotionsRequest& request) {
  const std::vector<MovingSegmentPair> pairs = read_segment_motions(request.file);
  const ContactLimit limit{request.radius, request.radius, request.margin};
  TextOutput output(std::cout);
  for (const ContactTime& time : contact_times_of(pairs, limit, request.tolerance)) {
    output.write_row(time.hit, time.lower, time.upper, time.certain);
  }
  output.flush();
  return SUCCEEDED;
}

}  // namespace

void add_segments(CLI::App& app, Command& command) {
  CLI::App* segments = app.add_subcommand(
      "segments",
      "the distance of each pair of segments, and bounds the true one lies between: "
      "[name,]distance,lower,upper,s,t");
  const auto request = std::make_shared<SegmentsRequest>();
  segments
      ->add_option("FILE", request->file,
                   "a pair per line: [name,] and the coordinates of p0, p1, q0 and q1 [m]")
      ->required();
  add_kernel_option(*segments, request->kernel);
  segments->callback([&command, request] { command = [request] { return run(*request); }; });
}

void add_motions(CLI::App& app, Command& command) {
  CLI::App* motions = app.add_subcommand(
      "motions",
      "when each pair of moving capsules first touches, as a part of its motion: "
      "hit,lower,upper,certain");
  const auto request = std::make_shared<MotionsRequest>();
  motions
      ->add_option(
          "FILE", request->file,
          "a pair per line: set, truth, and the coordinates of a0, a1, b0 and b1 at t = 0, "
          "then at t = 1 [m]")
      ->required();
  motions->add_option("--radius", request->radius, "of each of the two capsules [m]")
      ->check(length())
      ->capture_default_str();
  motions
      ->add_option("--margin", request->margin,
                   "a gap of at most this is contact [m]; inf for no limit")
      ->check(length_or_infinity())
      ->capture_default_str();
  motions
      ->add_option("--tolerance", request->tolerance,
                   "at `upper` the gap is at most this above the margin [m]")
      ->check(finite_number(0.0))
      ->capture_default_str();
  motions->callback([&command, request] { command = [request] { return run(*request); }; });
}

}  // namespace fiber

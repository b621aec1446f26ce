#include "src/tools/motions_command.hpp"

#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "src/io/number.hpp"
#include "src/io/segment_motions.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {
namespace {

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

void write_csv(TextOutput& output, const ContactTime& time) {
  std::string& text = output.text();
  text += time.hit ? "1," : "0,";
  append_number(text, time.lower);
  text += ',';
  append_number(text, time.upper);
  text += time.certain ? ",1\n" : ",0\n";
  output.flush_if_long();
}

ExitCode run(const MotionsRequest& request) {
  const std::vector<MovingSegmentPair> pairs = read_segment_motions(request.file);
  const ContactLimit limit{request.radius, request.radius, request.margin};
  TextOutput output(std::cout);
  for (const ContactTime& time : contact_times_of(pairs, limit, request.tolerance)) {
    write_csv(output, time);
  }
  output.flush();
  return SUCCEEDED;
}

}  // namespace

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

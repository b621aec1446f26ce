#include <algorithm>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>

#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "src/text/quote.hpp"
#include "src/tools/fiber_query.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {
namespace {

struct SweepCommand : FiberRequest, SweepRequest {};

/// What to report of a step, sorted by pair; what is in contact before it is earliest.
std::vector<MotionContact> reported(const SweepRequest& request, const MotionResult& result) {
  std::vector<MotionContact> contacts = result.contacts;
  if (!request.new_only) {
    contacts.insert(contacts.end(), result.touching.begin(), result.touching.end());
  }
  if (request.motion.type == MotionType::FIRST && !contacts.empty()) {
    return {*std::min_element(
        contacts.begin(), contacts.end(),
        [](const MotionContact& x, const MotionContact& y) { return x.earlier_than(y); })};
  }
  std::sort(contacts.begin(), contacts.end(),
            [](const MotionContact& x, const MotionContact& y) { return x.key() < y.key(); });
  return contacts;
}

ExitCode run(const SweepCommand& request) {
  const std::unique_ptr<ProximityEngine> engine =
      make_engine(request.engine, request.engine_options);
  const FiberFile file = read_fibers(request.file, request.radius);
  if (file.frames.size() < 2) {
    throw std::invalid_argument(quote(request.file) + " has " +
                                (file.has_frames ? "one frame" : "no frames") +
                                ", a motion needs at least two");
  }
  TextOutput output(std::cout);
  output.write(sweep_columns);
  MotionResult result;
  for (std::size_t i = 0; i + 1 < file.frames.size(); ++i) {
    const FiberFrame& from = file.frames[i];
    const FiberFrame& to = file.frames[i + 1];
    const bool moves = from.fibers.offsets() == to.fibers.offsets();
    if (!moves) {
      std::cerr << "fiber_query: frames " << from.frame << " and " << to.frame
                << " have different fibres: of frame " << from.frame
                << " the contacts it has itself\n";
    }
    engine->update_motion(from.fibers, moves ? to.fibers : from.fibers);
    engine->query_motion(request.motion, result);
    for (const MotionContact& contact : reported(request, result)) {
      output.write_row(from.frame, contact.fiber_a, contact.segment_a, contact.fiber_b,
                       contact.segment_b, contact.lower, contact.upper);
    }
    output.flush();
  }
  return SUCCEEDED;
}

}  // namespace

void add_sweep(CLI::App& app, Command& command) {
  CLI::App* sweep = app.add_subcommand(
      "sweep", "pairs of segments that come into contact from each frame to the next");
  const auto request = std::make_shared<SweepCommand>();
  add_fiber_options(*sweep, *request);
  add_sweep_options(*sweep, *request);
  sweep->callback([&command, request] {
    validate(request->motion);
    command = [request] { return run(*request); };
  });
}

}  // namespace fiber

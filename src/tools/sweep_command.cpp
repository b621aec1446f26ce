#include <algorithm>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "src/text/quote.hpp"
#include "src/tools/fiber_match.hpp"
#include "src/tools/fiber_query.hpp"
#include "src/tools/read_input.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {
namespace {

struct SweepCommand : FiberRequest, SweepRequest {};

using MotionContacts = std::vector<MotionContact>;

/// Answers about the steps from frame to frame.
class Sweeper {
 public:
  Sweeper(ProximityEngine& engine, const SweepRequest& request)
      : engine_(engine), request_(request) {}

  /// The contacts of a step, by the indices of its first frame.
  MotionContacts contacts(const FiberFrame& from, const FiberFrame& to, const FiberMatch& match) {
    const std::size_t count = from.fibers.fiber_count();
    if (is_all(match.before, count) && is_all(match.after, to.fibers.fiber_count())) {
      return contacts_between(from.fibers, to.fibers, request_.motion);
    }
    MotionContacts contacts;
    if (!match.before.empty()) {
      const FiberAssembly before = select_fibers(from.fibers, match.before);
      const FiberAssembly after = select_fibers(to.fibers, match.after);
      contacts = contacts_between(before, after, request_.motion);
      for (MotionContact& contact : contacts) {
        contact.fiber_a = match.before[contact.fiber_a];
        contact.fiber_b = match.before[contact.fiber_b];
      }
    }
    if (!match.others.empty()) {
      MotionOptions all = request_.motion;
      all.type = MotionType::ALL;
      for (const MotionContact& contact : contacts_between(from.fibers, from.fibers, all)) {
        if (match.is_other(contact.fiber_a) || match.is_other(contact.fiber_b)) {
          contacts.push_back(contact);
        }
      }
    }
    return contacts;
  }

 private:
  MotionContacts contacts_between(const FiberAssembly& before, const FiberAssembly& after,
                                  const MotionOptions& options) {
    engine_.update_motion(before, after);
    engine_.query_motion(options, result_);
    MotionContacts contacts = result_.contacts;
    if (!request_.new_only) {
      contacts.insert(contacts.end(), result_.touching.begin(), result_.touching.end());
    }
    return contacts;
  }

  ProximityEngine& engine_;
  const SweepRequest& request_;
  MotionResult result_;
};

/// What to report of them, sorted by pair; what is in contact before the step is earliest.
MotionContacts reported(const SweepRequest& request, MotionContacts contacts) {
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
  const FiberFile file = read_input("fiber_query", request.file, request.radius);
  if (file.frames.size() < 2) {
    throw std::invalid_argument(quote(request.file) + " has " +
                                (file.has_frames ? "one frame" : "no frames") +
                                ", a motion needs at least two");
  }
  TextOutput output(std::cout);
  output.write(sweep_columns);
  Sweeper sweeper(*engine, request);
  for (std::size_t i = 0; i + 1 < file.frames.size(); ++i) {
    const FiberFrame& from = file.frames[i];
    const FiberFrame& to = file.frames[i + 1];
    const FiberMatch match = match_fibers(from, to);
    if (!match.difference.empty()) {
      std::cerr << "fiber_query: " << match.difference << '\n';
    }
    for (const MotionContact& contact : reported(request, sweeper.contacts(from, to, match))) {
      output.write_row(from.frame, FiberCalled{from.names, contact.fiber_a}, contact.segment_a,
                       FiberCalled{from.names, contact.fiber_b}, contact.segment_b, contact.lower,
                       contact.upper);
    }
    output.flush();
  }
  return SUCCEEDED;
}

}  // namespace

void add_sweep(CLI::App& app, Command& command) {
  CLI::App* sweep = app.add_subcommand(
      "sweep",
      "pairs of segments that come into contact from each frame to the next; fibres are the same "
      "that have the same names");
  const auto request = std::make_shared<SweepCommand>();
  add_fiber_options(*sweep, *request);
  add_sweep_options(*sweep, *request);
  sweep->callback([&command, request] {
    validate(request->motion);
    command = [request] { return run(*request); };
  });
}

}  // namespace fiber

// `fiber_query sweep`: contacts between the frames of a file.
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "src/tools/fiber_match.hpp"
#include "src/tools/fiber_query.hpp"
#include "src/tools/read_input.hpp"
#include "src/tools/sweep_steps.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {
namespace {

struct SweepCommand : SweepRequest {
  std::string engine = "run_tree";
};

using MotionContacts = std::vector<MotionContact>;

/// Answers about the steps from frame to frame.
class Sweeper {
 public:
  Sweeper(ProximityEngine& engine, const SweepRequest& request)
      : engine_(engine), request_(request) {}

  /// The contacts to report of a step, by the indices of its first frame, sorted by pair.
  MotionContacts contacts(const FiberFrame& from, const FiberFrame& to, const FiberMatch& match) {
    const std::size_t count = from.fibers.fiber_count();
    const auto between = [this](const FiberAssembly& before, const FiberAssembly& after,
                                const std::vector<std::uint32_t>& fibers,
                                const MotionOptions& options) {
      MotionContacts contacts = contacts_between(before, after, options);
      for (MotionContact& contact : contacts) {
        contact.fiber_a = fibers[contact.fiber_a];
        contact.fiber_b = fibers[contact.fiber_b];
      }
      return contacts;
    };
    MotionContacts contacts =
        is_all(match.before, count) && is_all(match.after, to.fibers.fiber_count())
            ? contacts_between(from.fibers, to.fibers, request_.motion)
            : contacts_of_step<MotionContact>(from.fibers, to.fibers, match, !match.before.empty(),
                                              request_.motion, between);
    std::sort(contacts.begin(), contacts.end(),
              [](const MotionContact& x, const MotionContact& y) { return x.key() < y.key(); });
    if (request_.motion.type == MotionType::FIRST && !contacts.empty()) {
      return {*earliest(contacts)};
    }
    return contacts;
  }

 private:
  MotionContacts contacts_between(const FiberAssembly& before, const FiberAssembly& after,
                                  const MotionOptions& options) {
    engine_.update_motion(before, after);
    engine_.query_motion(options, result_);
    return take_contacts(result_, request_.new_only);
  }

  ProximityEngine& engine_;
  const SweepRequest& request_;
  MotionResult result_;
};

ExitCode run(const SweepCommand& request) {
  const std::unique_ptr<ProximityEngine> engine =
      make_engine(request.engine, request.engine_options);
  const FiberFile file = read_input("fiber_query", request.file, request.reading);
  require_motion(request.file, file.has_frames, file.frames.size());
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
    write_sweep_rows(output, from.frame, from.names, sweeper.contacts(from, to, match));
    output.flush();
  }
  return SUCCEEDED;
}

}  // namespace

void add_sweep(CLI::App& app, Command& command) {
  const auto request = std::make_shared<SweepCommand>();
  CLI::App* const sweep = add_sweep_options(app, *request);
  add_fiber_options(*sweep, *request, file_help, threads_help);
  add_engine_option(*sweep, request->engine);
  sweep->callback([&command, request] {
    validate(request->motion);
    command = [request] { return run(*request); };
  });
}

}  // namespace fiber

// `fiber_query_mpi sweep`: contacts between the frames of a file.
#include <algorithm>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/mpi/communicator.hpp"
#include "src/text/quote.hpp"
#include "src/tools/fiber_query.hpp"
#include "src/tools/fiber_query_mpi.hpp"
#include "src/tools/fiber_source.hpp"
#include "src/tools/mpi_tool.hpp"
#include "src/tools/rank_text.hpp"

namespace fiber {
namespace {

struct SweepMpiRequest : RankRequest, SweepRequest {
  std::string out;  // "" for stdout
};

struct NumberedFrame {
  std::int64_t number = 0;
  DistributedFibers fibers;
};

/// Whether all ranks have the same parts of both frames.
bool have_same_fibers(const Communicator& ranks, const DistributedFibers& x,
                      const DistributedFibers& y) {
  return ranks.all(x.parts.offsets() == y.parts.offsets() && x.names == y.names);
}

/// What to report of a step, in the order of pairs; what is in contact before it is earliest.
void sort_reported(const Communicator& ranks, const SweepRequest& request,
                   DistributedMotionResult& result) {
  std::vector<DistributedMotionContact>& contacts = result.contacts;
  if (!request.new_only) {
    contacts.insert(contacts.end(), result.touching.begin(), result.touching.end());
  }
  result.touching.clear();
  sort_over_ranks(ranks.handle(), result);
  if (request.motion.type != MotionType::FIRST) {
    return;
  }
  // Times are the same for several: the first of these in the order of pairs.
  const auto first =
      std::min_element(contacts.begin(), contacts.end(),
                       [](const auto& x, const auto& y) { return x.lower < y.lower; });
  const double lower = contacts.empty() ? 2.0 : first->lower;  // times are at most 1
  const std::vector<double> of_ranks = ranks.gather_all(lower);
  const auto earliest = std::min_element(of_ranks.begin(), of_ranks.end());
  const bool is_mine = !contacts.empty() && earliest - of_ranks.begin() == ranks.rank();
  contacts = is_mine ? std::vector<DistributedMotionContact>{*first}
                     : std::vector<DistributedMotionContact>();
}

ExitCode run(const SweepMpiRequest& request) {
  const Communicator ranks(MPI_COMM_WORLD);
  require_other_file(ranks, request.file, request.out);
  DistributedEngine engine(MPI_COMM_WORLD, request.engine_options);
  FiberSource source(ranks, request.file, request.radius);
  if (source.frame_count() < 2) {
    throw std::invalid_argument(quote(request.file) + " has " +
                                (source.has_frames() ? "one frame" : "no frames") +
                                ", a motion needs at least two");
  }
  RankText text(ranks, request.out);
  text.append([&](TextOutput& output) {
    if (ranks.rank() == 0) {
      output.write(sweep_columns);
    }
  });
  Progress progress = rank_progress(ranks);
  NumberedFrame from;
  NumberedFrame to;
  from.number = source.read(0, from.fibers);
  DistributedMotionResult result;
  for (std::size_t i = 0; i + 1 < source.frame_count(); ++i) {
    to.number = source.read(i + 1, to.fibers);
    const bool moves = have_same_fibers(ranks, from.fibers, to.fibers);
    if (!moves && ranks.rank() == 0) {
      std::cerr << "fiber_query_mpi: frames " << from.number << " and " << to.number
                << " have different fibres: of frame " << from.number
                << " the contacts it has itself\n";
    }
    engine.update_motion(from.fibers.parts, moves ? to.fibers.parts : from.fibers.parts,
                         from.fibers.names);
    engine.query_motion(request.motion, result);
    sort_reported(ranks, request, result);
    text.append([&](TextOutput& output) {
      for (const DistributedMotionContact& contact : result.contacts) {
        output.write_row(from.number, contact.fiber_a, contact.segment_a, contact.fiber_b,
                         contact.segment_b, contact.lower, contact.upper);
      }
    });
    std::swap(from, to);
    show_done(progress, i + 1, source.frame_count() - 1, "steps");
  }
  text.finish();
  return SUCCEEDED;
}

}  // namespace

void add_sweep_mpi(CLI::App& app, Command& command) {
  CLI::App* const sweep = app.add_subcommand(
      "sweep", "pairs of segments that come into contact from each frame to the next");
  const auto request = std::make_shared<SweepMpiRequest>();
  add_rank_options(*sweep, *request);
  sweep->add_option("--out", request->out,
                    "CSV to write, which has its name once it is whole; without this, to what "
                    "mpirun takes as output");
  add_sweep_options(*sweep, *request);
  sweep->callback([&command, request] {
    validate(request->motion);
    command = [request] { return run(*request); };
  });
}

}  // namespace fiber

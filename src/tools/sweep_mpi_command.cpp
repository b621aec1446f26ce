// `fiber_query_mpi sweep`: contacts between the frames of a file.
#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/io/file_format.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_name_text.hpp"
#include "src/mpi/gather_fibers.hpp"
#include "src/tools/fiber_match.hpp"
#include "src/tools/fiber_query_mpi.hpp"
#include "src/tools/fiber_source.hpp"
#include "src/tools/mpi_tool.hpp"
#include "src/tools/parallel_text_file.hpp"
#include "src/tools/sweep_steps.hpp"

namespace fiber {
namespace {

struct SweepMpiRequest : SweepRequest {
  std::string out;  // "" for stdout
};

struct NumberedFrame {
  std::int64_t number = 0;
  DistributedFibers fibers;
};

using RankContacts = std::vector<DistributedMotionContact>;

/// Whether all ranks have the same parts of both frames, of fibres of the same names.
bool have_same_fibers(const Communicator& ranks, const DistributedFibers& x,
                      const DistributedFibers& y) {
  return ranks.all(x.parts.has_topology_of(y.parts) && x.names == y.names &&
                   x.fiber_names == y.fiber_names && x.topology.closed == y.topology.closed &&
                   x.topology.joints == y.topology.joints &&
                   x.topology.joint_tolerance == y.topology.joint_tolerance);
}

/// Answers about the steps from frame to frame.
class RankSweeper {
 public:
  RankSweeper(const Communicator& ranks, const SweepRequest& request)
      : ranks_(ranks), request_(request), engine_(ranks.handle(), request.engine_options) {}

  /// Contacts of this rank in a step, and those that there are before it.
  /// @param from what is left of it serves no more; its fibres' names are those of the contacts
  RankContacts contacts(NumberedFrame& from, const NumberedFrame& to) {
    if (have_same_fibers(ranks_, from.fibers, to.fibers)) {
      return contacts_between(from.fibers.parts, to.fibers.parts, from.fibers.names,
                              from.fibers.topology, request_.motion);
    }
    // Fibres that come and go, or stand elsewhere in the file, are on rank 0 as they would be
    // without ranks.
    const FiberFrame before = whole(from.number, std::move(from.fibers));
    const FiberFrame after = whole(to.number, to.fibers);
    from.fibers.fiber_names = broadcast_names(ranks_, before.names);
    FiberMatch match = match_fibers(before, after);
    if (!match.difference.empty()) {
      std::cerr << "fiber_query_mpi: " << match.difference << '\n';
    }
    match.others = ranks_.broadcast(std::move(match.others));
    return contacts_of_step<DistributedMotionContact>(
        before.fibers, after.fibers, match, ranks_.broadcast(!match.before.empty()),
        request_.motion,
        [this](const FiberAssembly& x, const FiberAssembly& y,
               const std::vector<std::uint32_t>& fibers, const MotionOptions& options) {
          std::vector<FiberPart> parts(fibers.size());
          std::transform(fibers.begin(), fibers.end(), parts.begin(), [](std::uint32_t fiber) {
            return FiberPart{fiber, 0};
          });
          return contacts_between(x, y, parts, {}, options);
        });
  }

 private:
  FiberFrame whole(std::int64_t number, DistributedFibers fibers) const {
    WholeFibers all = gather_fibers(ranks_, std::move(fibers));
    return {number, std::move(all.fibers), std::move(all.names)};
  }

  RankContacts contacts_between(const FiberAssembly& before, const FiberAssembly& after,
                                const std::vector<FiberPart>& names, const FiberTopology& topology,
                                const MotionOptions& options) {
    DistributedMotionResult result;
    engine_.update_motion(before, after, names, topology);
    engine_.query_motion(options, result);
    return take_contacts(result, request_.new_only);
  }

  const Communicator& ranks_;
  const SweepRequest& request_;
  DistributedEngine engine_;
};

/// The contacts to report of a step, sorted by pair over the ranks.
RankContacts reported(const Communicator& ranks, const SweepRequest& request,
                      RankContacts contacts) {
  DistributedMotionResult result;
  result.contacts = std::move(contacts);
  sort_over_ranks(ranks.handle(), result);
  if (request.motion.type != MotionType::FIRST) {
    return std::move(result.contacts);
  }
  const auto first = earliest(result.contacts);
  const bool has_any = first != result.contacts.end();
  const std::vector<double> of_ranks = ranks.gather_all(has_any ? first->lower : 2.0);  // at most 1
  const auto rank = std::min_element(of_ranks.begin(), of_ranks.end()) - of_ranks.begin();
  return has_any && rank == ranks.rank() ? RankContacts{*first} : RankContacts();
}

ExitCode run(const SweepMpiRequest& request) {
  require_format(FileFormat::CSV, "--out", request.out);
  const Communicator ranks(MPI_COMM_WORLD);
  require_other_file(ranks, request.file, request.out);
  RankSweeper sweeper(ranks, request);
  FiberSource source(ranks, request.file, request.reading, FrameSharing::PARTS);
  require_motion(request.file, source.has_frames(), source.frame_count());
  ParallelTextFile text(ranks, request.out);
  text.append([&](TextOutput& output) {
    if (ranks.rank() == 0) {
      output.write(sweep_columns);
    }
  });
  Progress progress = rank_progress(ranks);
  NumberedFrame from;
  NumberedFrame to;
  from.number = source.read(0, from.fibers);
  for (std::size_t i = 0; i + 1 < source.frame_count(); ++i) {
    to.number = source.read(i + 1, to.fibers);
    const RankContacts contacts = reported(ranks, request, sweeper.contacts(from, to));
    text.append([&](TextOutput& output) {
      write_sweep_rows(output, from.number, from.fibers.fiber_names, contacts);
    });
    std::swap(from, to);
    show_done(progress, i + 1, source.frame_count() - 1, "steps");
  }
  text.finish();
  return SUCCEEDED;
}

}  // namespace

void add_sweep_mpi(CLI::App& app, Command& command) {
  const auto request = std::make_shared<SweepMpiRequest>();
  CLI::App* const sweep = add_sweep_options(app, *request);
  add_rank_options(*sweep, *request);
  add_out_option(*sweep, request->out, ".csv");
  sweep->callback([&command, request] {
    validate(request->motion);
    command = [request] { return run(*request); };
  });
}

}  // namespace fiber

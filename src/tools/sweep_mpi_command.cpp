// `fiber_query_mpi sweep`: contacts between the frames of a file.
#include <algorithm>
#include <iostream>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/io/file_format.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_name_text.hpp"
#include "src/mpi/gather_fibers.hpp"
#include "src/text/quote.hpp"
#include "src/tools/fiber_match.hpp"
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

using MotionContacts = std::vector<DistributedMotionContact>;

/// Whether all ranks have the same parts of both frames, of fibres of the same names.
bool have_same_fibers(const Communicator& ranks, const DistributedFibers& x,
                      const DistributedFibers& y) {
  return ranks.all(x.parts.offsets() == y.parts.offsets() && x.names == y.names &&
                   x.fiber_names == y.fiber_names);
}

/// Answers about the steps from frame to frame.
class RankSweeper {
 public:
  RankSweeper(const Communicator& ranks, const RankRequest& file, const SweepRequest& request)
      : ranks_(ranks), request_(request), engine_(ranks.handle(), file.engine_options) {}

  /// Contacts of this rank in a step, and those that there are before it.
  /// @param from what is left of it serves no more; its fibres' names are those of the contacts
  DistributedMotionResult contacts(NumberedFrame& from, const NumberedFrame& to) {
    if (have_same_fibers(ranks_, from.fibers, to.fibers)) {
      return contacts_between(from.fibers.parts, to.fibers.parts, from.fibers.names,
                              request_.motion);
    }
    return contacts_of_whole(from, to);
  }

 private:
  /// Fibres that come and go, or stand elsewhere in the file, are on rank 0 as they would be
  /// without ranks.
  DistributedMotionResult contacts_of_whole(NumberedFrame& from, const NumberedFrame& to) {
    const FiberFrame before = whole(from.number, std::move(from.fibers));
    const FiberFrame after = whole(to.number, to.fibers);
    from.fibers.fiber_names = broadcast_names(ranks_, before.names);
    FiberMatch match = match_fibers(before, after);
    if (!match.difference.empty()) {
      std::cerr << "fiber_query_mpi: " << match.difference << '\n';
    }
    match.others = ranks_.broadcast(std::move(match.others));
    DistributedMotionResult result;
    if (ranks_.broadcast(!match.before.empty())) {
      result = contacts_between(select_fibers(before.fibers, match.before),
                                select_fibers(after.fibers, match.after), whole_parts(match.before),
                                request_.motion);
    }
    if (!match.others.empty()) {
      MotionOptions all = request_.motion;
      all.type = MotionType::ALL;
      std::vector<std::uint32_t> every(before.fibers.fiber_count());
      std::iota(every.begin(), every.end(), 0U);
      for (const DistributedMotionContact& contact :
           contacts_between(before.fibers, before.fibers, whole_parts(every), all).contacts) {
        if (match.is_other(contact.fiber_a) || match.is_other(contact.fiber_b)) {
          result.contacts.push_back(contact);
        }
      }
    }
    return result;
  }

  FiberFrame whole(std::int64_t number, DistributedFibers fibers) const {
    WholeFibers all = gather_fibers(ranks_, std::move(fibers));
    return {number, std::move(all.fibers), std::move(all.names)};
  }

  static std::vector<FiberPart> whole_parts(const std::vector<std::uint32_t>& fibers) {
    std::vector<FiberPart> parts;
    parts.reserve(fibers.size());
    for (const std::uint32_t fiber : fibers) {
      parts.push_back({fiber, 0});
    }
    return parts;
  }

  DistributedMotionResult contacts_between(const FiberAssembly& before, const FiberAssembly& after,
                                           const std::vector<FiberPart>& names,
                                           const MotionOptions& options) {
    DistributedMotionResult result;
    engine_.update_motion(before, after, names);
    engine_.query_motion(options, result);
    if (!request_.new_only) {
      result.contacts.insert(result.contacts.end(), result.touching.begin(), result.touching.end());
    }
    result.touching.clear();
    return result;
  }

  const Communicator& ranks_;
  const SweepRequest& request_;
  DistributedEngine engine_;
};

/// What to report of a step, in the order of pairs; what is in contact before it is earliest.
void sort_reported(const Communicator& ranks, const SweepRequest& request,
                   DistributedMotionResult& result) {
  MotionContacts& contacts = result.contacts;
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
  contacts = is_mine ? MotionContacts{*first} : MotionContacts();
}

ExitCode run(const SweepMpiRequest& request) {
  require_format(FileFormat::CSV, "--out", request.out);
  const Communicator ranks(MPI_COMM_WORLD);
  require_other_file(ranks, request.file, request.out);
  RankSweeper sweeper(ranks, request, request);
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
  for (std::size_t i = 0; i + 1 < source.frame_count(); ++i) {
    to.number = source.read(i + 1, to.fibers);
    DistributedMotionResult result = sweeper.contacts(from, to);
    sort_reported(ranks, request, result);
    text.append([&](TextOutput& output) {
      const FiberNames& names = from.fibers.fiber_names;
      for (const DistributedMotionContact& contact : result.contacts) {
        output.write_row(from.number, FiberCalled{names, contact.fiber_a}, contact.segment_a,
                         FiberCalled{names, contact.fiber_b}, contact.segment_b, contact.lower,
                         contact.upper);
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
      "sweep",
      "pairs of segments that come into contact from each frame to the next; fibres are the same "
      "that have the same names");
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

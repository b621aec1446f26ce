// `fiber_query_mpi check`: ranks share out which candidates each of them checks.
#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "src/io/file_format.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/work_queue.hpp"
#include "src/tools/candidate_checker.hpp"
#include "src/tools/fiber_query_mpi.hpp"
#include "src/tools/fiber_source.hpp"
#include "src/tools/mpi_tool.hpp"
#include "src/tools/packed.hpp"
#include "src/tools/parallel_text_file.hpp"

namespace fiber {
namespace {

// Each rank checks so many candidates on average before their rows are put in order and written.
// The rows are in memory until then, and lost if the run is killed.
constexpr std::uint64_t max_in_memory = 8192;

struct RankCheckRequest : CheckRequest {
  std::string out;  // "" for stdout
  bool resume = false;
};

/// Names all that the answer depends on.
std::string run_of(const Communicator& ranks, const CheckRequest& request) {
  const auto text_of_file = [&](const std::string& path) {
    return path.empty() ? std::string("none") : description_of_file(ranks, path);
  };
  return "check of " + text_of_file(request.file) + ", " + text_of(request.reading) +
         ", environment " + text_of_file(request.environment) + ", fibers " +
         text_of_file(request.fibers) + ", self " + (request.without_self ? "no" : "yes") +
         ", type " + request.type + text_of_pairs(request.query);
}

/// The rows of a range of the candidates.
struct RangeRows {
  std::uint64_t begin = 0;
  std::string text;
};

/// Sends rows between the ranks so that those of a rank come before those of the next one.
/// Collective.
/// @param all  the candidates that were shared out
/// @param rows of this rank, in any order
/// @return the rows that this rank has then, in order
std::vector<RangeRows> sort_rows(const Communicator& ranks, const WorkRange& all,
                                 std::vector<RangeRows> rows) {
  const auto rank_count = static_cast<std::size_t>(ranks.size());
  PerRank<char> packed(rank_count);
  for (RangeRows& range : rows) {
    const std::size_t to = (range.begin - all.begin) * rank_count / (all.end - all.begin);
    pack(packed[to], std::vector{range.begin});
    pack(packed[to], range.text);
    range.text = {};
  }
  packed = ranks.exchange(std::move(packed));
  rows.clear();
  for (const std::vector<char>& from : packed) {
    for (const char* next = from.data(); next != from.data() + from.size();) {
      const auto begin = unpack<std::vector<std::uint64_t>>(next);
      rows.push_back({begin.front(), unpack<std::string>(next)});
    }
  }
  std::sort(rows.begin(), rows.end(),
            [](const RangeRows& x, const RangeRows& y) { return x.begin < y.begin; });
  return rows;
}

ExitCode run(const RankCheckRequest& request) {
  require_format(FileFormat::CSV, "--out", request.out);
  const Communicator ranks(MPI_COMM_WORLD);
  for (const std::string& in : {request.file, request.environment, request.fibers}) {
    require_other_file(ranks, in, request.out);
  }
  std::optional<FiberFrame> fibers;
  if (!request.fibers.empty()) {
    fibers = FiberSource(ranks, request.fibers, request.reading, FrameSharing::WHOLE)
                 .take_first_on_all();
  }
  std::optional<CandidateChecker> checker;
  ranks.throw_on_all(error_in([&] { checker.emplace(request, std::move(fibers)); }));
  FiberSource source(ranks, request.file, request.reading, FrameSharing::WHOLE);
  ParallelTextFile text(ranks, request.out,
                        {source.has_frames(), run_of(ranks, request), request.resume});
  if (text.done() == 0) {
    text.append([&](TextOutput& output) {
      output.write(ranks.rank() == 0 ? check_header(source.has_frames()) : "");
    });
  }
  Progress progress = rank_progress(ranks);
  const std::uint64_t count = source.frame_count();
  const std::uint64_t step = max_in_memory * static_cast<std::uint64_t>(ranks.size());
  for (std::uint64_t begin = text.done(); begin < count; begin += step) {
    const std::uint64_t end = std::min(begin + step, count);
    std::vector<RangeRows> checked;
    WorkQueue work{{begin, end}, candidates_at_once};
    work.work = [&](const WorkRange& range, const std::vector<char>& packed) {
      RangeRows rows{range.begin, {}};
      TextOutput output([&rows](std::string_view piece) { rows.text += piece; });
      checker->check(source.take(range, packed), source.has_frames(), output);
      output.flush();
      checked.push_back(std::move(rows));
    };
    if (source.is_packed()) {
      work.pack = [&](const WorkRange& range) { return source.pack(range); };
    }
    work.show = [&](std::uint64_t taken) { show_done(progress, taken, count, "candidates"); };
    run_work_queue(ranks, work);
    checked = sort_rows(ranks, work.all, std::move(checked));
    text.append([&](TextOutput& output) {
      for (const RangeRows& range : checked) {
        output.write(range.text);
      }
    });
    text.checkpoint(end);
  }
  text.finish();
  return SUCCEEDED;
}

}  // namespace

void add_check_mpi(CLI::App& app, Command& command) {
  const auto request = std::make_shared<RankCheckRequest>();
  request->threads = 1;  // ranks share a machine
  CLI::App* const check = app.add_subcommand(
      "check", "which candidates could be there, and what the others touch; ranks share them out");
  add_check_options(*check, *request,
                    "fibre file, each frame a candidate: .h5, of which each rank reads those that "
                    "it checks; .csv or .hair, which rank 0 reads",
                    rank_threads_help);
  add_out_option(*check, request->out, ".csv");
  check->add_flag("--resume", request->resume,
                  "go on with the --out of a run that was killed, after its last checkpoint");
  check->callback([&command, request] {
    finish_check_options(*request);
    command = [request] { return run(*request); };
  });
}

}  // namespace fiber

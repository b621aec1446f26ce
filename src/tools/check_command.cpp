// `fiber_query_mpi check`: which of many candidates could be there.
#include <tbb/task_arena.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/environment/check_fibers.hpp"
#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "src/io/file_format.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/work_queue.hpp"
#include "src/query/threads.hpp"
#include "src/text/quote.hpp"
#include "src/tools/candidate_source.hpp"
#include "src/tools/check_rows.hpp"
#include "src/tools/fiber_query.hpp"
#include "src/tools/fiber_query_mpi.hpp"
#include "src/tools/fiber_source.hpp"
#include "src/tools/mpi_tool.hpp"
#include "src/tools/range_texts.hpp"
#include "src/tools/rank_text.hpp"

namespace fiber {
namespace {

// So many are checked before their rows are put in order and written, by each rank on average: they
// are in memory until then, and lost if a run is killed.
constexpr std::uint64_t most_in_memory = 8192;

// For one rank: as many as take some milliseconds, beside which a message is nothing.
constexpr std::uint64_t candidates_at_once = 256;

struct CheckRequest {
  std::string file;
  double radius = 0.0;  // [m]
  std::string environment;
  std::string fibers;
  std::string type = "first";
  QueryOptions query;
  bool without_self = false;
  std::uint32_t threads = 1;
  std::string out;  // "" for stdout
  bool resume = false;
};

/// All that the answer depends on.
std::string run_of(const Communicator& ranks, const CheckRequest& request) {
  const auto text_of_file = [&](const std::string& path) {
    return path.empty() ? std::string("none") : description_of_file(ranks, path);
  };
  return "check of " + text_of_file(request.file) + ", radius " + text_of(request.radius) +
         ", environment " + text_of_file(request.environment) + ", fibers " +
         text_of_file(request.fibers) + ", self " + (request.without_self ? "no" : "yes") +
         ", type " + request.type + text_of_pairs(request.query);
}

/// What stands around the candidates, on every rank.
class Around {
 public:
  /// Collective.
  /// @throws std::invalid_argument on all ranks
  Around(const Communicator& ranks, const CheckRequest& request) {
    ranks.throw_on_all(error_in([&] {
      if (!request.environment.empty()) {
        read_environment(request.environment);
      }
    }));
    if (!request.fibers.empty()) {
      read_fibers_on_all(ranks, request);
    }
    surroundings_.environment = environment_ ? &*environment_ : nullptr;
    surroundings_.fibers = engine_.get();
    surroundings_.self = !request.without_self;
  }
  Around(const Around&) = delete;
  Around& operator=(const Around&) = delete;

  /// For candidates of at most so many fibres, of these names.
  const Surroundings& surroundings(const FiberNames& names, std::size_t fiber_count) {
    if (fiber_count > fiber_count_ || names != names_) {
      names_ = names;
      fiber_count_ = fiber_count;
      surroundings_.allowed = resolve(allowed_, names.list(fiber_count));
    }
    return surroundings_;
  }

  const Environment* environment() const { return surroundings_.environment; }

  /// Of the fibres that there are.
  const FiberNames& fiber_names() const { return fibers_.names; }

 private:
  void read_environment(const std::string& path) {
    const MeshSource meshes = mesh_files(std::filesystem::path(path).parent_path());
    EnvironmentScene scene = read_environment_scene(load_yaml(path), meshes);
    std::vector<EnvironmentObject> objects;
    for (SceneObstacle& obstacle : scene.obstacles) {
      const std::string& frame = scene.obstacles.front().frame_id;
      if (obstacle.frame_id != frame) {
        throw std::invalid_argument(path + ": obstacle " + quote(obstacle.object.name) +
                                    " is in frame " + quote(obstacle.frame_id) +
                                    ", all must be in that of the fibres, as the first one, " +
                                    quote(frame));
      }
      objects.push_back(std::move(obstacle.object));
    }
    environment_.emplace(std::move(objects));
    allowed_ = std::move(scene.allowed);
  }

  void read_fibers_on_all(const Communicator& ranks, const CheckRequest& request) {
    CandidateSource source(ranks, request.fibers, request.radius);
    fibers_ = source.take_on_all(ranks, 0);
    EngineOptions options;
    options.threads = request.threads;
    engine_ = make_engine("run_tree", options);
    engine_->update(fibers_.fibers);
  }

  std::optional<Environment> environment_;
  std::vector<NamedPair> allowed_;
  FiberFrame fibers_;
  std::unique_ptr<ProximityEngine> engine_;

  // Of the candidates that `allowed` of these is for:
  Surroundings surroundings_;
  FiberNames names_;
  std::size_t fiber_count_ = 0;
};

/// Checks candidates on this rank.
class RankChecker {
 public:
  RankChecker(CandidateSource& source, Around& around, const CheckRequest& request)
      : source_(source),
        around_(around),
        options_(request.query),
        arena_(arena_concurrency(request.threads)) {}

  RangeText check(const WorkRange& range, const std::vector<char>& packed) {
    std::vector<FiberFrame> frames = source_.take(range, packed);
    std::ostringstream rows;
    TextOutput output(rows);
    for (auto begin = frames.begin(); begin != frames.end();) {
      const auto end = std::find_if(begin, frames.end(), [&](const FiberFrame& frame) {
        return frame.names != begin->names;
      });
      check_alike(begin, end, output);
      begin = end;
    }
    output.flush();
    return {range.begin, rows.str()};
  }

 private:
  using Frames = std::vector<FiberFrame>::iterator;

  /// Candidates whose fibres have the same names, which say what they may touch.
  void check_alike(Frames begin, Frames end, TextOutput& output) {
    candidates_.clear();
    std::size_t fiber_count = 0;
    for (auto frame = begin; frame != end; ++frame) {
      fiber_count = std::max(fiber_count, frame->fibers.fiber_count());
      candidates_.push_back(std::move(frame->fibers));
    }
    const Surroundings& surroundings = around_.surroundings(begin->names, fiber_count);
    arena_.execute([&] { check_fibers(candidates_, surroundings, options_, checks_); });
    for (const FiberCheck& check : checks_) {
      write_check(output, {source_.has_frames(), begin->frame}, check,
                  {begin->names, around_.fiber_names()}, around_.environment());
      ++begin;
    }
  }

  CandidateSource& source_;
  Around& around_;
  const QueryOptions options_;
  tbb::task_arena arena_;
  std::vector<FiberAssembly> candidates_;
  std::vector<FiberCheck> checks_;
};

ExitCode run(const CheckRequest& request) {
  require_format(FileFormat::CSV, "--out", request.out);
  const Communicator ranks(MPI_COMM_WORLD);
  for (const std::string& in : {request.file, request.environment, request.fibers}) {
    require_other_file(ranks, in, request.out);
  }
  Around around(ranks, request);
  CandidateSource source(ranks, request.file, request.radius);
  RankText text(ranks, request.out, {run_of(ranks, request), request.resume});
  if (text.done() == 0) {
    text.append([&](TextOutput& output) {
      output.write(ranks.rank() == 0 ? check_header(source.has_frames()) : "");
    });
  }
  RankChecker checker(source, around, request);
  Progress progress = rank_progress(ranks);
  const std::uint64_t count = source.frame_count();
  const std::uint64_t step = most_in_memory * static_cast<std::uint64_t>(ranks.size());
  for (std::uint64_t begin = text.done(); begin < count; begin += step) {
    const std::uint64_t end = std::min(begin + step, count);
    std::vector<RangeText> checked;
    WorkQueue work{{begin, end}, candidates_at_once};
    work.work = [&](const WorkRange& range, const std::vector<char>& packed) {
      checked.push_back(checker.check(range, packed));
    };
    if (source.is_packed()) {
      work.pack = [&](const WorkRange& range) { return source.pack(range); };
    }
    work.show = [&](std::uint64_t dealt) { show_done(progress, dealt, count, "candidates"); };
    run_work_queue(ranks, work);
    checked = sort_over_ranks(ranks, work.all, std::move(checked));
    text.append([&](TextOutput& output) {
      for (const RangeText& range : checked) {
        output.write(range.text);
      }
    });
    text.note(end);
  }
  text.finish();
  return SUCCEEDED;
}

}  // namespace

void add_check(CLI::App& app, Command& command) {
  const auto request = std::make_shared<CheckRequest>();
  CLI::App* const subcommand = app.add_subcommand(
      "check", "which candidates could be there, and what the others touch, dealt out among ranks");
  subcommand
      ->add_option("CANDIDATES", request->file,
                   "fibre file, each frame a candidate: .h5, of which each rank reads those that "
                   "it checks; .csv or .hair, which rank 0 reads")
      ->required();
  subcommand->add_option("--environment", request->environment,
                         "file with what stands around them (.yaml)");
  subcommand->add_option("--fibers", request->fibers,
                         "fibre file whose first frame holds the fibres that there are");
  subcommand->add_flag("--without-self", request->without_self,
                       "a candidate's contacts with itself do not count");
  subcommand
      ->add_option("--margin", request->query.margin,
                   "pairs with a gap of at most this are contacts [m]; inf for no limit")
      ->capture_default_str();
  subcommand
      ->add_option("--type", request->type,
                   "first: a candidate's check ends at its first contact, which is the fastest; "
                   "closest, all, fiber_pairs: of it with itself, with the fibres and with objects")
      ->check(CLI::IsMember({"first", "closest", "all", "fiber_pairs"}))
      ->capture_default_str();
  subcommand->add_option("--radius", request->radius, "of all fibres, if a file has no radii [m]")
      ->capture_default_str();
  subcommand
      ->add_option("--threads", request->threads,
                   "most threads that each rank uses, 0 for as many as there are cores")
      ->check(whole_number(0))
      ->capture_default_str();
  add_neighbour_options(*subcommand, request->query.neighbour_skip,
                        request->query.neighbour_skip_length);
  add_kernel_option(*subcommand, request->query.kernel);
  subcommand->add_option("--out", request->out,
                         "write to this file (.csv), which has its name once it is whole; without "
                         "this, to what mpirun takes as output");
  subcommand->add_flag("--resume", request->resume,
                       "go on with the --out of a run that was killed, after the last candidates "
                       "that it has noted");
  subcommand->callback([&command, request] {
    request->query.type = query_type_from_name(request->type);
    validate(request->query);
    command = [request] { return run(*request); };
  });
}

}  // namespace fiber

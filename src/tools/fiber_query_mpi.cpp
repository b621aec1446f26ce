// fiber_query over the ranks of MPI: the same contacts. What rank 0 says of errors is enough.
#include "src/tools/fiber_query_mpi.hpp"

#include <mpi.h>

#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/io/file_format.hpp"
#include "src/io/number.hpp"
#include "src/mpi/communicator.hpp"
#include "src/tools/contact_rows.hpp"
#include "src/tools/contact_sink.hpp"
#include "src/tools/fiber_source.hpp"
#include "src/tools/mpi_tool.hpp"

namespace fiber {
namespace {

struct MpiRequest : FiberRequest {
  PairRequest pairs;
  std::string out;  // "" for stdout
  std::optional<std::string> format;
  bool resume = false;
};

/// The question that a subcommand asks.
struct Question {
  std::string name;
  QueryOptions query;
};

/// Names all that the answer depends on.
std::string run_of(const Communicator& ranks, const MpiRequest& request, const Question& question) {
  const QueryOptions& query = question.query;
  return question.name + " of " + description_of_file(ranks, request.file) + ", " +
         text_of(request.reading) + text_of_pairs(query) + ", tolerance " +
         text_of(query.tolerance) + ", relative_tolerance " + text_of(query.relative_tolerance) +
         ", deadline " + text_of(query.deadline);
}

/// @throws std::invalid_argument for options that do not go together
ContactTarget target_of(const MpiRequest& request) {
  const FileFormat meant = format_of(request.out);
  const std::string format = request.format.value_or(meant == FileFormat::HDF5   ? "hdf5"
                                                     : meant == FileFormat::JSON ? "json"
                                                                                 : "csv");
  const bool is_hdf5 = format == "hdf5";
  if (is_hdf5 && request.out.empty()) {
    throw std::invalid_argument("--format hdf5 needs a file to write: give it with --out");
  }
  require_format(is_hdf5            ? FileFormat::HDF5
                 : format == "json" ? FileFormat::JSON
                                    : FileFormat::CSV,
                 "--out", request.out);
  if (request.resume && !is_hdf5) {
    throw std::invalid_argument(
        "--resume: only files of HDF5 can be gone on with, give --out a name that ends in .h5");
  }
  return {request.out, is_hdf5            ? ContactFormat::HDF5
                       : format == "json" ? ContactFormat::JSON
                                          : ContactFormat::CSV};
}

ExitCode run(const MpiRequest& request, const Question& question) {
  const ContactTarget target = target_of(request);
  const Communicator ranks(MPI_COMM_WORLD);
  require_other_file(ranks, request.file, request.out);
  DistributedEngine engine(MPI_COMM_WORLD, request.engine_options);
  FiberSource source(ranks, request.file, request.reading, FrameSharing::PARTS);
  DistributedFileOptions options;
  options.has_frames = source.has_frames();
  options.resume = request.resume;
  options.run = run_of(ranks, request, question);
  ContactSink sink(ranks, target, options);
  Progress progress = rank_progress(ranks);
  DistributedFibers fibers;
  DistributedResult result;
  for (std::size_t i = sink.done(); i < source.frame_count(); ++i) {
    const std::int64_t frame = source.read(i, fibers);
    engine.update(fibers.parts, fibers.names, fibers.topology);
    fibers.parts = {};  // the engine has its own, and contacts need the memory
    fibers.names = {};
    fibers.topology = {};
    engine.query(question.query, result);
    const FrameNumber number{source.has_frames(), frame};
    sink.write(number, fibers.fiber_names, result);
    if (!result.complete) {
      std::cerr << "fiber_query_mpi: " << deadline_warning(number) << '\n';
    }
    show_done(progress, i + 1, source.frame_count(), "frames");
  }
  sink.finish();
  return SUCCEEDED;
}

void add_output_options(CLI::App& app, MpiRequest& request) {
  add_out_option(app, request.out, ".h5, .csv or .json");
  app.add_option("--format", request.format,
                 std::string(format_help) + "; without this, by the end of its name, else csv")
      ->check(CLI::IsMember({"csv", "json", "hdf5"}));
  app.add_flag("--resume", request.resume,
               "go on after the last whole frame of a run that was interrupted (.h5)");
}

void add_pair_queries(CLI::App& app, Command& command) {
  const auto request = std::make_shared<MpiRequest>();
  for (const PairQuery& query : pair_queries()) {
    CLI::App* const subcommand = app.add_subcommand(query.name, query.description);
    add_rank_options(*subcommand, *request);
    add_output_options(*subcommand, *request);
    add_pair_options(*subcommand, query, request->pairs);
    subcommand->callback([&command, request, query] {
      const QueryOptions options = options_of(query, request->pairs);
      const Question question{query.name, options};
      command = [request, question] { return run(*request, question); };
    });
  }
}

void setup_mpi(CLI::App& app, Command& command) {
  app.require_subcommand(0, 1);
  add_pair_queries(app, command);
  add_check_mpi(app, command);
  add_convert(app, command);
  add_sweep_mpi(app, command);
}

}  // namespace

std::string text_of_pairs(const QueryOptions& query) {
  const auto text_of_option = [](const auto& value) {
    return value ? text_of(*value) : std::string("none");
  };
  return ", margin " + text_of(query.margin) + ", neighbour_skip " +
         text_of_option(query.neighbour_skip) + ", neighbour_skip_length " +
         text_of_option(query.neighbour_skip_length) + ", kernel " + name_of(query.kernel);
}

void add_rank_options(CLI::App& app, FiberRequest& request) {
  request.engine_options.threads = 1;
  add_fiber_options(app, request,
                    "fibre file: .h5, of which each rank reads its part; .hair, or CSV as "
                    "fiber_query reads it, which rank 0 reads",
                    rank_threads_help);
}

void add_out_option(CLI::App& app, std::string& out, const std::string& ends) {
  app.add_option("--out", out,
                 "write to this file (" + ends +
                     "), which has its name once it is whole; without this, to what mpirun takes "
                     "as output");
}

}  // namespace fiber

int main(int argc, char** argv) {
  return fiber::run_mpi_tool("fiber_query_mpi",
                             "Contacts of the fibres in a file, found by the ranks of mpirun",
                             fiber::setup_mpi, argc, argv);
}

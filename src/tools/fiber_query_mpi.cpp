// fiber_query over the ranks of MPI: the same contacts. What rank 0 says of errors is enough.
#include "src/tools/fiber_query_mpi.hpp"

#include <mpi.h>

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/io/number.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/part_loads.hpp"
#include "src/mpi/plan.hpp"
#include "src/mpi/step_costs.hpp"
#include "src/tools/contact_sink.hpp"
#include "src/tools/fiber_query.hpp"
#include "src/tools/fiber_source.hpp"
#include "src/tools/mpi_tool.hpp"
#include "src/tools/plan_output.hpp"

namespace fiber {
namespace {

struct MpiRequest {
  std::string file;
  double radius = 0.0;  // [m]
  EngineOptions engine_options;
  QueryOptions query;
  std::string out;  // "" for stdout
  std::optional<std::string> format;
  bool resume = false;
  PlanRequest plan;
};

/// All that the answer depends on but the file.
std::string run_of(const MpiRequest& request) {
  const QueryOptions& query = request.query;
  const auto text_of_option = [](const auto& value) {
    return value ? text_of(*value) : std::string("none");
  };
  return "radius " + text_of(request.radius) + ", margin " + text_of(query.margin) +
         ", neighbour_skip " + text_of_option(query.neighbour_skip) + ", neighbour_skip_length " +
         text_of_option(query.neighbour_skip_length) + ", kernel " + name_of(query.kernel);
}

/// @throws std::invalid_argument for options that do not go together
ContactTarget target_of(const MpiRequest& request) {
  const bool is_hdf5 = request.format ? *request.format == "hdf5" : is_hdf5_name(request.out);
  if (is_hdf5 && request.out.empty()) {
    throw std::invalid_argument("--format hdf5 needs a file to write: give it with --out");
  }
  if (request.resume && !is_hdf5) {
    throw std::invalid_argument(
        "--resume: only files of HDF5 can be gone on with, give --out a name that ends in .h5");
  }
  return {request.out, is_hdf5};
}

ExitCode run(const MpiRequest& request) {
  const ContactTarget target = target_of(request);
  const Communicator ranks(MPI_COMM_WORLD);
  require_other_file(ranks, request.file, request.out);
  DistributedEngine engine(MPI_COMM_WORLD, request.engine_options);
  FiberSource source(ranks, request.file, request.radius);
  DistributedFileOptions options;
  options.has_frames = source.has_frames();
  options.resume = request.resume;
  options.run = "contacts of " + description_of_file(ranks, request.file) + ", " + run_of(request);
  ContactSink sink(ranks, target, options);
  Progress progress = rank_progress(ranks);
  DistributedFibers fibers;
  DistributedResult result;
  for (std::size_t i = sink.done(); i < source.frame_count(); ++i) {
    const std::int64_t frame = source.read(i, fibers);
    engine.update(fibers.parts, fibers.names);
    engine.query(request.query, result);
    sink.write({source.has_frames(), frame}, result);
    show_frames(progress, i + 1, source.frame_count());
  }
  sink.finish();
  return SUCCEEDED;
}

/// What more ranks would hold of the first frame.
ExitCode plan_file(const MpiRequest& request) {
  const Communicator ranks(MPI_COMM_WORLD);
  FiberSource source(ranks, request.file, request.radius);
  DistributedFibers fibers;
  source.read(0, fibers);
  std::vector<PlannedPart> parts =
      plan_of(part_loads(ranks, fibers, request.plan.parts, request.query.margin));
  predict_steps(parts, measure_steps(ranks, fibers, request.engine_options, request.query),
                request.plan.network);
  on_first_rank(ranks, [&] { write_plan(parts); });
  return SUCCEEDED;
}

void setup_mpi(CLI::App& app, Command& command) {
  app.require_subcommand(0, 1);
  const auto request = std::make_shared<MpiRequest>();
  CLI::App* const contacts =
      app.add_subcommand("contacts", "all pairs of segments within the margin");
  contacts
      ->add_option(
          "FILE", request->file,
          "fibre file: .h5, of which each rank reads its part; .csv or .hair, which rank 0 "
          "reads")
      ->required();
  contacts->add_option("--radius", request->radius, "of all fibres, if the file has no radii [m]")
      ->capture_default_str();
  request->engine_options.threads = 1;
  contacts
      ->add_option("--threads", request->engine_options.threads,
                   "most threads that each rank uses, 0 for as many as there are cores")
      ->check(whole_number(0))
      ->capture_default_str();
  contacts
      ->add_option("--margin", request->query.margin,
                   "pairs with a gap of at most this [m]; inf for no limit")
      ->capture_default_str();
  CLI::Option* const out =
      contacts->add_option("--out", request->out,
                           "write to this file, .h5 or .csv, which has its name once it is whole; "
                           "without this, to what mpirun takes as output");
  add_plan_options(*contacts, request->plan, "of the file's first frame; contacts are not written")
      ->excludes(out);
  contacts
      ->add_option("--format", request->format,
                   "of the output; without this, hdf5 if its name ends in .h5, else csv")
      ->check(CLI::IsMember({"csv", "hdf5"}));
  contacts->add_flag("--resume", request->resume,
                     "go on after the last whole frame of a run that was interrupted (.h5)");
  add_neighbour_options(*contacts, request->query.neighbour_skip,
                        request->query.neighbour_skip_length);
  add_kernel_option(*contacts, request->query.kernel);
  contacts->callback([&command, request] {
    validate(request->query);
    command = [request] { return request->plan.parts > 0 ? plan_file(*request) : run(*request); };
  });
  add_convert(app, command);
}

}  // namespace
}  // namespace fiber

int main(int argc, char** argv) {
  return fiber::run_mpi_tool("fiber_query_mpi",
                             "Contacts of the fibres in a file, found by the ranks of mpirun",
                             fiber::setup_mpi, argc, argv);
}

// fiber_query over the ranks of MPI: the same bytes. Rank 0 reads and writes; what it says of
// errors is enough.
#include <mpi.h>

#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/io/file.hpp"
#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "src/mpi/communicator.hpp"
#include "src/tools/contact_rows.hpp"
#include "src/tools/fiber_query.hpp"
#include "src/tools/mpi_tool.hpp"

namespace fiber {
namespace {

struct MpiRequest {
  std::string file;
  double radius = 0.0;  // [m]
  EngineOptions engine_options;
  QueryOptions query;
  std::string out;  // "" for stdout
};

/// Where rank 0 writes: stdout, or a file that has its name only once it is whole.
class Answer {
 public:
  explicit Answer(std::string path)
      : path_(std::move(path)),
        file_(path_.empty() ? nullptr : std::make_unique<OutputFile>(aside())),
        text_(file_ != nullptr ? file_->stream() : std::cout) {}
  ~Answer() {
    if (file_ != nullptr) {
      std::error_code ignored;
      std::filesystem::remove(aside(), ignored);
    }
  }
  Answer(const Answer&) = delete;
  Answer& operator=(const Answer&) = delete;

  TextOutput& text() { return text_; }

  void finish() {
    if (file_ != nullptr) {
      file_->close();
      std::filesystem::rename(aside(), path_);
      file_.reset();
    }
  }

 private:
  std::string aside() const { return path_ + ".part"; }

  const std::string path_;
  std::unique_ptr<OutputFile> file_;  // none for stdout
  TextOutput text_;
};

/// Whole fibres by the order of their file.
std::vector<FiberPart> names_of(const FiberAssembly& fibers) {
  std::vector<FiberPart> names(fibers.fiber_count());
  for (std::size_t fiber = 0; fiber < names.size(); ++fiber) {
    names[fiber].fiber = fiber;
  }
  return names;
}

ExitCode run(const MpiRequest& request) {
  const Communicator ranks(MPI_COMM_WORLD);
  DistributedEngine engine(MPI_COMM_WORLD, request.engine_options);
  FiberFile file;
  std::optional<Answer> answer;
  on_first_rank(ranks, [&] {
    file = read_fibers(request.file, request.radius);
    answer.emplace(request.out);
    answer->text().write((file.has_frames ? "frame," : "") + std::string(contact_columns));
    answer->text().flush();
  });
  const std::uint64_t frame_count = ranks.sum(file.frames.size());  // the others have none
  const FiberAssembly nothing;
  DistributedResult result;
  for (std::uint64_t i = 0; i < frame_count; ++i) {
    const bool is_first = ranks.rank() == 0;
    const FiberAssembly& fibers = is_first ? file.frames[i].fibers : nothing;
    engine.update(fibers, names_of(fibers));
    engine.query(request.query, result);
    const DistributedResult all = gather(MPI_COMM_WORLD, result);
    on_first_rank(ranks, [&] {
      write_csv_contacts(answer->text(), {file.has_frames, file.frames[i].frame}, all.contacts);
      answer->text().flush();
    });
  }
  on_first_rank(ranks, [&] { answer->finish(); });
  return SUCCEEDED;
}

void setup_mpi(CLI::App& app, Command& command) {
  app.require_subcommand(0, 1);
  const auto request = std::make_shared<MpiRequest>();
  CLI::App* const contacts =
      app.add_subcommand("contacts", "all pairs of segments within the margin, as CSV");
  contacts->add_option("FILE", request->file, "fibre file (.csv or .hair); rank 0 reads it")
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
  contacts->add_option("--out", request->out,
                       "write to this file, which has its name once it is whole; without this, to "
                       "what mpirun takes as output");
  add_neighbour_options(*contacts, request->query.neighbour_skip,
                        request->query.neighbour_skip_length);
  add_kernel_option(*contacts, request->query.kernel);
  contacts->callback([&command, request] {
    validate(request->query);
    command = [request] { return run(*request); };
  });
}

}  // namespace
}  // namespace fiber

int main(int argc, char** argv) {
  return fiber::run_mpi_tool("fiber_query_mpi",
                             "Contacts of the fibres in a file, found by the ranks of mpirun",
                             fiber::setup_mpi, argc, argv);
}

// `fiber_query_mpi convert`: fibres from one format to another.
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/io/file_format.hpp"
#include "src/io/one_frame.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/gather_fibers.hpp"
#include "src/mpi/partial_file.hpp"
#include "src/text/quote.hpp"
#include "src/tools/fiber_query_mpi.hpp"
#include "src/tools/fiber_source.hpp"
#include "src/tools/mpi_tool.hpp"
#include "src/tools/query_options.hpp"

namespace fiber {
namespace {

constexpr const char* ends_of_out = ".h5, .csv, .hair, .npz, .tck, .trk or .vtp";

struct ConvertRequest {
  std::string in;
  std::string out;
  ReadOptions reading;
  bool resume = false;
};

void convert_to_hdf5(const Communicator& ranks, const ConvertRequest& request,
                     FiberSource& source) {
  DistributedFileOptions options;
  options.has_frames = source.has_frames();
  options.resume = request.resume;
  options.run =
      "fibres of " + description_of_file(ranks, request.in) + ", " + text_of(request.reading);
  DistributedFiberWriter writer(ranks.handle(), request.out, options);
  Progress progress = rank_progress(ranks);
  DistributedFibers fibers;
  for (std::size_t i = writer.done(); i < source.frame_count(); ++i) {
    const std::int64_t frame = source.read(i, fibers);
    writer.write(frame, fibers);
    show_done(progress, i + 1, source.frame_count(), "frames");
  }
  writer.finish();
}

/// A file that rank 0 writes, in a format that has no parts.
class SerialFile {
 public:
  SerialFile(WritePlace place, FileFormat format, bool has_frames)
      : place_(std::move(place)), format_(format), has_frames_(has_frames) {
    if (format == FileFormat::CSV) {
      csv_.emplace(written(), has_frames);
    } else if (place_.is_file) {
      OutputFile(written()).close();  // whether it can be written
    }
  }
  ~SerialFile() {
    if (place_.is_file) {
      remove_partial(place_.path);
    }
  }
  SerialFile(const SerialFile&) = delete;
  SerialFile& operator=(const SerialFile&) = delete;

  void write(FiberFrame frame) {
    if (csv_) {
      csv_->write(frame);
      return;
    }
    FiberFile file{has_frames_, {}};
    file.frames.push_back(std::move(frame));
    const std::string bytes = encoded(format_, file);
    OutputFile output(written());
    output.write(bytes);
    output.close();
    for (const std::string& lost : losses(format_, file.frames.front())) {
      std::cerr << "fiber_query_mpi: " << place_.path << ": " << lost << '\n';
    }
  }

  void finish() {
    if (csv_) {
      csv_->finish();
    }
    if (place_.is_file) {
      move_into_place(place_.path);
    }
  }

 private:
  std::string written() const { return place_.is_file ? partial_name(place_.path) : place_.path; }

  const WritePlace place_;
  const FileFormat format_;
  const bool has_frames_;
  std::optional<CsvWriter> csv_;  // else a format of one frame
};

void convert_run_on_root(const Communicator& ranks, const ConvertRequest& request,
                         FiberSource& source) {
  std::optional<SerialFile> file;
  const WritePlace place = write_place(ranks, request.out);
  run_on_root(ranks, [&] { file.emplace(place, format_of(request.out), source.has_frames()); });
  Progress progress = rank_progress(ranks);
  DistributedFibers fibers;
  for (std::size_t i = 0; i < source.frame_count(); ++i) {
    const std::int64_t frame = source.read(i, fibers);
    WholeFibers all = gather_fibers(ranks, std::exchange(fibers, {}));
    run_on_root(ranks, [&] { file->write({frame, std::move(all.fibers), std::move(all.names)}); });
    show_done(progress, i + 1, source.frame_count(), "frames");
  }
  run_on_root(ranks, [&] { file->finish(); });
}

ExitCode convert(const ConvertRequest& request) {
  const std::optional<FileFormat> format = format_meant(request.out);
  const bool is_hdf5 = format == FileFormat::HDF5;
  if (!is_hdf5 && format != FileFormat::CSV && !(format && holds_one_frame(*format))) {
    throw std::invalid_argument("OUT: " + quote(request.out) + " must end in " + ends_of_out);
  }
  if (request.resume && !is_hdf5) {
    throw std::invalid_argument("--resume: only files of HDF5 can be gone on with, OUT is " +
                                quote(request.out));
  }
  const Communicator ranks(MPI_COMM_WORLD);
  require_other_file(ranks, request.in, request.out);
  FiberSource source(ranks, request.in, request.reading, FrameSharing::PARTS);
  if (is_hdf5) {
    convert_to_hdf5(ranks, request, source);
  } else {
    convert_run_on_root(ranks, request, source);
  }
  return SUCCEEDED;
}

}  // namespace

void add_convert(CLI::App& app, Command& command) {
  const auto request = std::make_shared<ConvertRequest>();
  CLI::App* const subcommand = app.add_subcommand(
      "convert", std::string("fibres in another format, as names end: ") + ends_of_out);
  subcommand->add_option("IN", request->in, "fibre file (.h5, or any that fiber_query reads)")
      ->required();
  subcommand
      ->add_option("OUT", request->out,
                   "what to write; all fibres of a frame are on rank 0 unless both files are .h5")
      ->required();
  add_read_options(*subcommand, request->reading);
  subcommand->add_flag("--resume", request->resume,
                       "go on after the last whole frame of a run that was interrupted (.h5)");
  subcommand->callback([&command, request] { command = [request] { return convert(*request); }; });
}

}  // namespace fiber

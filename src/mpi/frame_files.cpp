#include "src/mpi/frame_files.hpp"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <optional>
#include <regex>
#include <stdexcept>
#include <system_error>
#include <utility>
#include <vector>

#include "fiber_proximity/io/file.hpp"
#include "src/io/file_format.hpp"
#include "src/mpi/hdf5_file.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

constexpr std::uint64_t space_of_names = 65'536;  // [byte] at most, of what is no data in a file
constexpr std::uint64_t space_of_link = 512;      // [byte] the same, of a link

/// Makes the unfinished file of a name, as large as it will be.
/// @throws FileError
void make_room(const std::string& path, std::uint64_t size) {
  OutputFile(partial_name(path)).close();
  try {
    reserve(partial_name(path), size);
  } catch (const FileError&) {
    remove_partial(path);
    throw;
  }
}

/// The file that all ranks write at once, each anywhere in it. Collective.
std::string place_of_file(const Communicator& ranks, const std::string& path) {
  const WritePlace place = write_place(ranks, path);
  ranks.throw_on_all(
      place.is_file
          ? ""
          : FileError(path, "is a device or a pipe: HDF5 can be written to a file only").what());
  return place.path;
}

/// Whether a file is one of our frames, finished or not.
bool is_frame_name(const std::string& name) {
  static const std::regex frame("[0-9]{6,}\\.h5(\\.part)?");
  return std::regex_match(name, frame);
}

}  // namespace

bool is_hdf5_name(const std::string& path) { return format_of(path) == FileFormat::HDF5; }

std::string frame_name(std::size_t index) {
  std::string digits = std::to_string(index);
  return std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
}

FrameFiles::FrameFiles(const Communicator& ranks, const std::string& path, std::string content,
                       DistributedFileOptions options)
    : ranks_(ranks),
      path_(place_of_file(ranks, path)),
      content_(std::move(content)),
      options_(std::move(options)) {
  const QuietHdf5 quiet;
  std::uint64_t done = 0;
  run_on_root(ranks_, [&] {
    if (options_.resume) {
      done = count_done();
    } else {
      begin_anew();
    }
    // Whether it can be written is known before hours of work.
    make_room(path_, space_of_names);
    remove_partial(path_);
  });
  done_ = ranks_.sum(done);
}

/// Makes room for the frames. What another run has written is no longer the recording of its name.
void FrameFiles::begin_anew() const {
  if (!options_.has_frames) {
    return;
  }
  std::filesystem::remove(path_);
  std::filesystem::create_directories(folder());
  for (const auto& entry : std::filesystem::directory_iterator(folder())) {
    if (is_frame_name(entry.path().filename().string())) {
      std::filesystem::remove(entry.path());
    }
  }
}

std::size_t FrameFiles::count_done() {
  if (!options_.has_frames) {
    return is_of_this_run(path_) ? 1 : 0;
  }
  std::filesystem::create_directories(folder());
  std::size_t count = 0;
  while (is_of_this_run(path_of(count))) {
    ++count;
  }
  return count;
}

/// @return false if there is none
/// @throws FileError if it is none of this run
bool FrameFiles::is_of_this_run(const std::string& path) {
  if (!std::filesystem::exists(path)) {
    return false;
  }
  try {
    const Hdf5Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose,
                      "is no whole HDF5 file");
    const std::optional<std::string> run = read_text(file.get(), attribute::run);
    if (read_text(file.get(), attribute::content) != content_ || !run) {
      throw std::runtime_error("holds no " + content_ + " of an earlier run");
    }
    if (*run != options_.run) {
      throw std::runtime_error("is of another run, " + quote(*run) + ", this one is " +
                               quote(options_.run));
    }
    frames_.insert(read_number(file.get(), attribute::frame).value_or(0));
    max_version_ = std::max(max_version_, read_number(file.get(), attribute::version).value_or(0));
  } catch (const std::exception& failure) {
    throw FileError(path, std::string("cannot be gone on with: ") + failure.what());
  }
  return true;
}

std::string FrameFiles::folder() const {
  return std::filesystem::path(path_).replace_extension(".frames").string();
}

std::string FrameFiles::path_of(std::size_t index) const {
  return options_.has_frames ? folder() + '/' + frame_name(index) + ".h5" : path_;
}

void FrameFiles::write_attributes(hid_t file, std::int64_t version) const {
  write_text(file, attribute::content, content_);
  write_numbers(file, attribute::version, {version});
  write_text(file, attribute::run, options_.run);
}

void FrameFiles::write(const FrameFacts& facts,
                       const std::function<void(hid_t file, FrameDatasets& datasets)>& make) {
  const QuietHdf5 quiet;
  const std::string path = path_of(done_);
  run_on_root(ranks_, [&] {
    if (!options_.has_frames && done_ > 0) {
      throw FileError(path_, "holds one frame, without a number: there cannot be another");
    }
    if (!frames_.insert(options_.has_frames ? facts.number : 0).second) {
      throw FileError(path_, "has a frame " + std::to_string(facts.number) + " already");
    }
    make_room(path, facts.data_size + space_of_names);
  });
  max_version_ = std::max(max_version_, facts.version);
  // All that is collective is done before a rank can fail alone.
  std::optional<Hdf5Id> file;
  FrameDatasets datasets;
  std::string error = error_in([&] {
    file.emplace(create_parallel_file(ranks_, partial_name(path)));
    write_attributes(file->get(), facts.version);
    if (options_.has_frames) {
      write_numbers(file->get(), attribute::frame, {facts.number});
    }
    make(file->get(), datasets);
  });
  bool went_well = ranks_.all(error.empty());
  if (went_well) {
    error = error_in([&] { datasets.write(); });
    went_well = ranks_.all(error.empty());
  }
  datasets.close();
  if (!went_well && ranks_.rank() == 0) {
    std::error_code ignored;
    std::filesystem::resize_file(partial_name(path), 0,
                                 ignored);  // HDF5 needs some space to give up
  }
  ranks_.throw_on_all("");
  if (file) {
    const std::string at_end = error_in([&] { file->close("cannot be written"); });
    error = error.empty() ? at_end : error;
  }
  if (!ranks_.all(error.empty()) && ranks_.rank() == 0) {
    remove_partial(path);
  }
  ranks_.throw_on_all(error.empty() ? "" : FileError(partial_name(path), error).what());
  run_on_root(ranks_, [&] { move_into_place(path); });
  ++done_;
}

void FrameFiles::write_links() const {
  make_room(path_, space_of_names + done_ * space_of_link);
  Hdf5Id file(H5Fcreate(partial_name(path_).c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT),
              H5Fclose, "cannot be written");
  write_attributes(file.get(), max_version_);
  write_numbers(file.get(), attribute::has_frames, {1});
  const Hdf5Id frames = create_group(file.get(), "frames");
  const std::string beside = std::filesystem::path(folder()).filename().string();
  for (std::size_t i = 0; i < done_; ++i) {
    require_success(
        H5Lcreate_external((beside + '/' + frame_name(i) + ".h5").c_str(), "/", frames.get(),
                           frame_name(i).c_str(), H5P_DEFAULT, H5P_DEFAULT),
        "cannot be written");
  }
  file.close("cannot be written");
}

void FrameFiles::finish() {
  const QuietHdf5 quiet;
  run_on_root(ranks_, [&] {
    if (!options_.has_frames && done_ == 0) {
      throw FileError(path_, "has no frame");
    }
    if (options_.has_frames) {
      const std::string error = error_in([&] { write_links(); });
      if (!error.empty()) {
        remove_partial(path_);
        throw FileError(partial_name(path_), error);
      }
      move_into_place(path_);
    }
  });
}

DistributedFileWriter::DistributedFileWriter(MPI_Comm ranks, const std::string& path,
                                             const char* content,
                                             const DistributedFileOptions& options)
    : state_(std::make_unique<State>(ranks, path, content, options)) {}

DistributedFileWriter::~DistributedFileWriter() = default;

std::size_t DistributedFileWriter::done() const { return state_->files.done(); }

void DistributedFileWriter::finish() { state_->files.finish(); }

}  // namespace fiber

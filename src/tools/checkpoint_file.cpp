#include "src/tools/checkpoint_file.hpp"

#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "fiber_proximity/io/file.hpp"
#include "src/mpi/partial_file.hpp"
#include "src/text/quote.hpp"

namespace fiber {

CheckpointFile::CheckpointFile(const std::string& path, std::string run)
    : part_(partial_name(path)), path_(part_ + ".run"), run_(std::move(run)) {}

std::optional<RunProgress> CheckpointFile::read() const {
  std::ifstream file(path_);
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(part_, error);
  if (!file || error) {
    return std::nullopt;
  }
  RunProgress progress;
  std::string rest;
  std::string run;
  file >> progress.steps >> progress.bytes;
  if (!std::getline(file, rest) || !std::getline(file, run) || !rest.empty() ||
      progress.bytes > size) {
    throw FileError(path_, "cannot be gone on with: does not tell how far " + part_ + " has come");
  }
  if (run != run_) {
    throw FileError(part_, "cannot be gone on with: is of another run, " + quote(run) +
                               ", this one is " + quote(run_));
  }
  return progress;
}

void CheckpointFile::write(const RunProgress& progress) const {
  OutputFile file(partial_name(path_));
  file.write(std::to_string(progress.steps) + " " + std::to_string(progress.bytes) + "\n" + run_ +
             "\n");
  file.close();
  move_into_place(path_);
}

void CheckpointFile::remove() const {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
  remove_partial(path_);
}

}  // namespace fiber

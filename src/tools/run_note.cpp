#include "src/tools/run_note.hpp"

#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "fiber_proximity/io/file.hpp"
#include "src/mpi/partial_file.hpp"
#include "src/text/quote.hpp"

namespace fiber {

RunNote::RunNote(const std::string& path, std::string run)
    : part_(partial_name(path)), name_(part_ + ".run"), run_(std::move(run)) {}

std::optional<RunProgress> RunNote::read() const {
  std::ifstream note(name_);
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(part_, error);
  if (!note || error) {
    return std::nullopt;
  }
  RunProgress progress;
  std::string rest;
  std::string run;
  note >> progress.steps >> progress.bytes;
  if (!std::getline(note, rest) || !std::getline(note, run) || !rest.empty() ||
      progress.bytes > size) {
    throw FileError(name_, "cannot be gone on with: does not tell how far " + part_ + " has come");
  }
  if (run != run_) {
    throw FileError(part_, "cannot be gone on with: is of another run, " + quote(run) +
                               ", this one is " + quote(run_));
  }
  return progress;
}

void RunNote::write(const RunProgress& progress) const {
  OutputFile file(partial_name(name_));
  file.write(std::to_string(progress.steps) + " " + std::to_string(progress.bytes) + "\n" + run_ +
             "\n");
  file.close();
  move_into_place(name_);
}

void RunNote::remove() const {
  std::error_code ignored;
  std::filesystem::remove(name_, ignored);
  remove_partial(name_);
}

}  // namespace fiber

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "fiber_proximity/io/file.hpp"
#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/mpi/fiber_data.hpp"
#include "src/mpi/fiber_layout.hpp"
#include "src/mpi/fiber_name_data.hpp"
#include "src/mpi/frame_files.hpp"
#include "src/mpi/hdf5_file.hpp"

namespace fiber {

struct DistributedFiberReader::State {
  State(MPI_Comm comm, std::string file_path) : ranks(comm), path(std::move(file_path)) {}

  Communicator ranks;
  const std::string path;
  std::optional<Hdf5Id> file;
  bool has_frames = false;
  std::size_t frame_count = 1;

  /// Does what may go wrong with the file.
  void do_or_agree(const std::string& place, const std::function<void()>& work) const;
  void open();
};

void DistributedFiberReader::State::do_or_agree(const std::string& place,
                                                const std::function<void()>& work) const {
  const std::string error = error_in(work);
  ranks.throw_on_all(error.empty() ? "" : FileError(path, place + error).what());
}

void DistributedFiberReader::State::open() {
  // Files of frames are looked for beside the file, not beside a link to it.
  file.emplace(open_parallel_file(ranks, std::filesystem::canonical(path).string()));
  if (read_text(file->get(), attribute::content) != layout::fibers) {
    throw std::runtime_error("is no file of fibres: its attribute fiber_proximity is not fibers");
  }
  read_version(file->get());
  has_frames = read_number(file->get(), attribute::has_frames).value_or(0) != 0;
  if (has_frames) {
    const Hdf5Id frames = open_group(file->get(), layout::frames);
    H5G_info_t info;
    require_success(H5Gget_info(frames.get(), &info), "group frames cannot be read");
    frame_count = info.nlinks;
  }
}

DistributedFiberReader::DistributedFiberReader(MPI_Comm ranks, const std::string& path)
    : state_(std::make_unique<State>(ranks, path)) {
  run_on_root(state_->ranks, [&] {
    errno = 0;
    if (std::ifstream file(path, std::ios::binary); !file) {
      throw FileError::from_system(path, "cannot be opened");
    }
  });
  const QuietHdf5 quiet;
  state_->do_or_agree("", [&] { state_->open(); });
}

DistributedFiberReader::~DistributedFiberReader() = default;

bool DistributedFiberReader::has_frames() const { return state_->has_frames; }

std::size_t DistributedFiberReader::frame_count() const { return state_->frame_count; }

std::int64_t DistributedFiberReader::read(std::size_t index, DistributedFibers& fibers) const {
  const QuietHdf5 quiet;
  const Communicator& ranks = state_->ranks;
  const auto size = static_cast<std::uint64_t>(ranks.size());
  const auto rank = static_cast<std::uint64_t>(ranks.rank());
  const std::string name = std::string(layout::frames) + '/' + frame_name(index);
  std::optional<Hdf5Id> frame;
  std::int64_t number = 0;
  state_->do_or_agree(state_->has_frames ? name + ": " : "", [&] {
    frame.emplace(open_group(state_->file->get(), state_->has_frames ? name : "/"));
    number = read_number(frame->get(), attribute::frame).value_or(0);
    const FiberData data(frame->get());
    const std::uint64_t count = data.segment_count();
    const std::uint64_t rest = count % size;
    const std::uint64_t begin = count / size * rank + std::min(rank, rest);
    const std::uint64_t end = begin + count / size + (rank < rest ? 1 : 0);
    fibers = data.read(data.find(begin), data.find(end));
    fibers.fiber_names = read_names(frame->get());
    require_names(fibers);
  });
  return number;
}

}  // namespace fiber

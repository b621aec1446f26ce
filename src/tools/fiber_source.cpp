#include "src/tools/fiber_source.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <utility>

#include "fiber_proximity/io/file.hpp"
#include "src/mpi/fiber_name_text.hpp"
#include "src/text/quote.hpp"
#include "src/tools/read_input.hpp"

namespace fiber {

FiberSource::FiberSource(const Communicator& ranks, const std::string& path, double radius)
    : ranks_(ranks) {
  if (is_hdf5_name(path)) {
    reader_.emplace(ranks.handle(), path);
    has_frames_ = reader_->has_frames();
    frame_count_ = reader_->frame_count();
    return;
  }
  run_on_root(ranks_, [&] { file_ = read_input("fiber_query_mpi", path, radius); });
  has_frames_ = ranks_.broadcast(file_.has_frames);
  frame_count_ = ranks_.broadcast(file_.frames.size());
}

std::int64_t FiberSource::read(std::size_t index, DistributedFibers& fibers) {
  if (reader_) {
    return reader_->read(index, fibers);
  }
  fibers = {};
  std::int64_t number = 0;
  if (ranks_.rank() == 0) {
    number = file_.frames[index].frame;
    fibers.parts = std::move(file_.frames[index].fibers);
    for (std::uint64_t fiber = 0; fiber < fibers.parts.fiber_count(); ++fiber) {
      fibers.names.push_back({fiber, 0});
    }
    fibers.fiber_names = file_.frames[index].names;
  }
  fibers.fiber_names = broadcast_names(ranks_, fibers.fiber_names);
  return ranks_.broadcast(number);
}

std::string description_of_file(const Communicator& ranks, const std::string& path) {
  struct Facts {
    std::int64_t size = 0;     // [byte]
    std::int64_t seconds = 0;  // since 1970, and
    std::int64_t nanoseconds = 0;
  };
  Facts facts;
  run_on_root(ranks, [&] {
    struct stat status {};
    errno = 0;
    if (stat(path.c_str(), &status) != 0) {
      throw FileError::from_system(path, "cannot be opened");
    }
    facts = {status.st_size, status.st_mtim.tv_sec, status.st_mtim.tv_nsec};
  });
  facts = ranks.broadcast(facts);
  return shortened(path, 4096) + " of " + std::to_string(facts.size) + " bytes and time " +
         std::to_string(facts.seconds) + '.' + std::to_string(facts.nanoseconds);
}

}  // namespace fiber

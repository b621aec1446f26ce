#include "src/tools/fiber_source.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <iostream>
#include <stdexcept>
#include <utility>

#include "fiber_proximity/io/file.hpp"
#include "src/mpi/fiber_name_text.hpp"
#include "src/mpi/gather_fibers.hpp"
#include "src/mpi/global_joints.hpp"
#include "src/text/quote.hpp"
#include "src/tools/packed.hpp"
#include "src/tools/read_input.hpp"

namespace fiber {
namespace {

void pack_frame(std::vector<char>& bytes, const FiberFrame& frame) {
  pack(bytes, std::vector{frame.frame});
  const FiberTopology topology = frame.fibers.topology();
  pack(bytes, frame.fibers.given_points());
  pack(bytes, frame.fibers.given_offsets());
  pack(bytes, frame.fibers.given_radii());
  pack(bytes, topology.closed);
  pack(bytes, topology.joints);
  pack(bytes, std::vector{topology.joint_tolerance.value_or(-1.0)});
  pack(bytes, text_of_names(frame.names));
}

FiberFrame unpack_frame(const char*& next) {
  const auto number = unpack<std::vector<std::int64_t>>(next);
  auto points = unpack<std::vector<Eigen::Vector3d>>(next);
  auto offsets = unpack<std::vector<std::uint32_t>>(next);
  auto radii = unpack<std::vector<double>>(next);
  FiberTopology topology;
  topology.closed = unpack<std::vector<std::uint8_t>>(next);
  topology.joints = unpack<std::vector<std::int32_t>>(next);
  if (const double tolerance = unpack<std::vector<double>>(next).front(); tolerance >= 0.0) {
    topology.joint_tolerance = tolerance;
  }
  return {number.front(),
          {std::move(points), std::move(offsets), std::move(radii), topology},
          names_in_text(unpack<std::vector<char>>(next))};
}

/// Does what only this rank does: errors do not begin with the number that it has in a group of its
/// own.
template <class Work>
void on_rank_alone(const std::string& context, const Work& work) {
  const std::string error = error_in(work);
  const std::string number = "rank 0: ";
  if (!error.empty()) {
    throw std::invalid_argument(
        context + (error.rfind(number, 0) == 0 ? error.substr(number.size()) : error));
  }
}

}  // namespace

FiberSource::FiberSource(const Communicator& ranks, const std::string& path,
                         const ReadOptions& reading, FrameSharing sharing)
    : ranks_(ranks), alone_(MPI_COMM_SELF), path_(path) {
  if (!is_hdf5_name(path)) {
    run_on_root(ranks_, [&] { file_ = read_input("fiber_query_mpi", path, reading); });
    has_frames_ = ranks_.broadcast(file_.has_frames);
    frame_count_ = ranks_.broadcast(file_.frames.size());
    return;
  }
  if (sharing == FrameSharing::PARTS) {
    reader_.emplace(ranks_.handle(), path);
  } else {
    ranks_.throw_on_all(
        error_in([&] { on_rank_alone("", [&] { reader_.emplace(alone_.handle(), path); }); }));
  }
  has_frames_ = reader_->has_frames();
  frame_count_ = reader_->frame_count();
}

std::int64_t FiberSource::read(std::size_t index, DistributedFibers& fibers) {
  std::int64_t number = 0;
  if (reader_) {
    number = reader_->read(index, fibers);
    tell_of_lonely_joints(number, fibers);
    return number;
  }
  fibers = {};
  if (ranks_.rank() == 0) {
    FiberFrame& frame = file_.frames[index];
    number = frame.frame;
    fibers.parts = std::move(frame.fibers);
    for (std::uint64_t fiber = 0; fiber < fibers.parts.fiber_count(); ++fiber) {
      fibers.names.push_back({fiber, 0});
    }
    fibers.fiber_names = frame.names;
  }
  fibers.fiber_names = broadcast_names(ranks_, fibers.fiber_names);
  return ranks_.broadcast(number);
}

/// Tells of the first number of a joint that one point alone has, as readers of other files do.
void FiberSource::tell_of_lonely_joints(std::int64_t number, const DistributedFibers& fibers) {
  const std::optional<std::int32_t> lonely = find_lonely_joint(ranks_, fibers);
  if (lonely && !is_lonely_told_) {
    is_lonely_told_ = true;
    std::cerr << "fiber_query_mpi: " << path_ << ": "
              << (has_frames_ ? "frame " + std::to_string(number) + ": " : "") << "joint "
              << *lonely << " is the number of one point alone: it joins nothing\n";
  }
}

std::vector<char> FiberSource::pack(const WorkRange& range) {
  std::vector<char> bytes;
  for (std::uint64_t i = range.begin; i < range.end; ++i) {
    pack_frame(bytes, std::exchange(file_.frames[i], {}));
  }
  return bytes;
}

FiberFrame FiberSource::read_alone(std::uint64_t index) const {
  FiberFrame frame;
  DistributedFibers fibers;
  on_rank_alone("", [&] { frame.frame = reader_->read(index, fibers); });
  on_rank_alone(path_ + ": frame " + std::to_string(frame.frame) + ": ", [&] {
    WholeFibers whole = gather_fibers(alone_, std::move(fibers));
    frame.fibers = std::move(whole.fibers);
    frame.names = std::move(whole.names);
  });
  return frame;
}

std::vector<FiberFrame> FiberSource::take(const WorkRange& range, const std::vector<char>& packed) {
  std::vector<FiberFrame> frames;
  frames.reserve(range.end - range.begin);
  const char* next = packed.data();
  for (std::uint64_t i = range.begin; i < range.end; ++i) {
    frames.push_back(reader_              ? read_alone(i)
                     : ranks_.rank() == 0 ? std::exchange(file_.frames[i], {})
                                          : unpack_frame(next));
  }
  return frames;
}

FiberFrame FiberSource::take_first_on_all() {
  ranks_.throw_on_all(frame_count_ > 0 ? "" : FileError(path_, "has no fibres").what());
  std::vector<char> packed;
  if (is_packed()) {
    packed = ranks_.broadcast(ranks_.rank() == 0 ? pack({0, 1}) : packed);
  }
  FiberFrame frame;
  ranks_.throw_on_all(error_in([&] {
    const char* next = packed.data();
    frame = reader_ ? read_alone(0) : unpack_frame(next);
  }));
  return frame;
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

#include "src/tools/candidate_source.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "fiber_proximity/io/file.hpp"
#include "src/mpi/gather_fibers.hpp"
#include "src/tools/read_input.hpp"

namespace fiber {
namespace {

/// Values one after another, as they are in memory.
class Packer {
 public:
  template <class T>
  void add(const T* values, std::uint64_t count) {
    const auto* const begin = reinterpret_cast<const char*>(values);
    bytes_.insert(bytes_.end(), begin, begin + count * sizeof(T));
  }
  template <class T>
  void add(const std::vector<T>& values) {
    const std::uint64_t count = values.size();
    add(&count, 1);
    add(values.data(), count);
  }
  void add(const FiberNames& names) {
    const std::uint64_t count = names.size();
    add(&count, 1);
    for (const std::string& name : names.list(count)) {
      add(std::vector<char>(name.begin(), name.end()));
    }
  }
  std::vector<char> take() { return std::move(bytes_); }

 private:
  std::vector<char> bytes_;
};

class Unpacker {
 public:
  explicit Unpacker(const std::vector<char>& bytes) : next_(bytes.data()) {}

  FiberFrame frame() {
    const auto number = value<std::int64_t>();
    auto points = values<Eigen::Vector3d>();
    auto offsets = values<std::uint32_t>();
    auto radii = values<double>();
    return {number, {std::move(points), std::move(offsets), std::move(radii)}, names()};
  }

 private:
  FiberNames names() {
    std::vector<std::string> names(value<std::uint64_t>());
    for (std::string& name : names) {
      const std::vector<char> letters = values<char>();
      name.assign(letters.begin(), letters.end());
    }
    return FiberNames(std::move(names));
  }

  template <class T>
  T value() {
    T value;
    copy(&value, 1);
    return value;
  }
  template <class T>
  std::vector<T> values() {
    std::vector<T> values(value<std::uint64_t>());
    copy(values.data(), values.size());
    return values;
  }
  template <class T>
  void copy(T* values, std::uint64_t count) {
    std::memcpy(static_cast<void*>(values), next_, count * sizeof(T));
    next_ += count * sizeof(T);
  }

  const char* next_;
};

/// What is said of a single rank, without its number: it is the one of a group of its own.
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

CandidateSource::CandidateSource(const Communicator& ranks, const std::string& path, double radius)
    : path_(path), is_first_rank_(ranks.rank() == 0), alone_(MPI_COMM_SELF) {
  if (is_hdf5_name(path)) {
    ranks.throw_on_all(
        error_in([&] { on_rank_alone("", [&] { reader_.emplace(alone_.handle(), path); }); }));
    has_frames_ = reader_->has_frames();
    frame_count_ = reader_->frame_count();
    return;
  }
  run_on_root(ranks, [&] { file_ = read_input("fiber_query_mpi", path, radius); });
  has_frames_ = ranks.broadcast(file_.has_frames);
  frame_count_ = ranks.broadcast<std::uint64_t>(file_.frames.size());
}

std::vector<char> CandidateSource::pack(const WorkRange& range) {
  Packer packer;
  for (std::uint64_t i = range.begin; i < range.end; ++i) {
    const FiberFrame frame = std::move(file_.frames[i]);
    packer.add(&frame.frame, 1);
    packer.add(frame.fibers.points());
    packer.add(frame.fibers.offsets());
    packer.add(frame.fibers.radii());
    packer.add(frame.names);
  }
  return packer.take();
}

FiberFrame CandidateSource::read(std::uint64_t index) const {
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

std::vector<FiberFrame> CandidateSource::take(const WorkRange& range,
                                              const std::vector<char>& packed) {
  std::vector<FiberFrame> frames;
  frames.reserve(range.end - range.begin);
  Unpacker unpacker(packed);
  for (std::uint64_t i = range.begin; i < range.end; ++i) {
    if (reader_) {
      frames.push_back(read(i));
    } else if (is_first_rank_) {
      frames.push_back(std::move(file_.frames[i]));
    } else {
      frames.push_back(unpacker.frame());
    }
  }
  return frames;
}

FiberFrame CandidateSource::take_on_all(const Communicator& ranks, std::uint64_t index) {
  ranks.throw_on_all(index < frame_count_ ? "" : FileError(path_, "has no fibres").what());
  const WorkRange range{index, index + 1};
  PerRank<char> to(static_cast<std::size_t>(ranks.size()));
  if (is_packed() && is_first_rank_) {
    std::fill(to.begin(), to.end(), pack(range));
  }
  const PerRank<char> packed = ranks.exchange(std::move(to));
  FiberFrame frame;
  ranks.throw_on_all(
      error_in([&] { frame = reader_ ? read(index) : Unpacker(packed.front()).frame(); }));
  return frame;
}

}  // namespace fiber

#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace fiber {

/// Whether objects of a type may be sent as their bytes: those that own nothing. Not asked for is
/// std::is_trivially_copyable, which Eigen 3.4's vectors are not.
template <class T>
constexpr bool is_sendable = std::is_trivially_destructible_v<T> && !std::is_polymorphic_v<T>;

/// A list per rank: what is sent to it, or what has come from it.
template <class T>
using PerRank = std::vector<std::vector<T>>;

/// The lists of all ranks as one, in the order of ranks.
template <class T>
std::vector<T> joined(const PerRank<T>& lists) {
  std::size_t count = 0;
  for (const std::vector<T>& list : lists) {
    count += list.size();
  }
  std::vector<T> all;
  all.reserve(count);
  for (const std::vector<T>& list : lists) {
    all.insert(all.end(), list.begin(), list.end());
  }
  return all;
}

/// The place of what a rank has among what all ranks have, in the order of ranks.
struct RankShare {
  std::uint64_t before = 0;  ///< what ranks of smaller numbers have
  std::uint64_t all = 0;
};

/// A group of ranks with messages of its own: those of others that use the same ranks never meet
/// them. All functions but rank() and size() are collective: every rank calls them, in one order.
class Communicator {
 public:
  /// @throws std::logic_error on every rank if MPI is not running, or was started without thread
  ///         support (MPI_THREAD_FUNNELED at least)
  explicit Communicator(MPI_Comm ranks);
  ~Communicator();
  Communicator(const Communicator&) = delete;
  Communicator& operator=(const Communicator&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }
  MPI_Comm handle() const { return ranks_; }

  /// Throws on all ranks if any has an error.
  /// @param error of this rank, "" for none
  /// @throws std::invalid_argument on every rank if any has an error: that of the lowest of these
  void throw_on_all(const std::string& error) const;

  bool all(bool value) const;
  double min(double value) const;
  double max(double value) const;
  std::uint64_t sum(std::uint64_t value) const;

  /// Tells where so many of this rank are among those of all ranks.
  RankShare share(std::uint64_t count) const;

  /// Gathers the value of each rank on all ranks.
  template <class T>
  std::vector<T> gather_all(const T& value) const {
    static_assert(is_sendable<T>);
    std::vector<T> values(static_cast<std::size_t>(size_));
    MPI_Allgather(&value, sizeof(T), MPI_BYTE, values.data(), sizeof(T), MPI_BYTE, ranks_);
    return values;
  }

  /// Returns the value of rank 0 on all ranks.
  template <class T>
  T broadcast(T value) const {
    static_assert(is_sendable<T>);
    MPI_Bcast(&value, sizeof(T), MPI_BYTE, 0, ranks_);
    return value;
  }

  /// Returns the list of rank 0 on all ranks.
  template <class T>
  std::vector<T> broadcast(std::vector<T> values) const {
    static_assert(is_sendable<T>);
    values.resize(broadcast<std::uint64_t>(values.size()));
    broadcast_bytes(values.data(), values.size() * sizeof(T));
    return values;
  }

  /// Sends what is for each rank, and takes what is for this one.
  template <class T>
  PerRank<T> exchange(PerRank<T> to) const;

  /// Tells each rank how much this one has for it.
  /// @return how much each rank has for this one
  std::vector<std::uint64_t> exchange_counts(const std::vector<std::uint64_t>& counts) const {
    std::vector<std::uint64_t> received(counts.size());
    MPI_Alltoall(counts.data(), 1, MPI_UINT64_T, received.data(), 1, MPI_UINT64_T, ranks_);
    return received;
  }

 private:
  void broadcast_bytes(void* data, std::size_t bytes) const;

  MPI_Comm ranks_ = MPI_COMM_NULL;
  int rank_ = 0;
  int size_ = 1;
};

/// @return what was thrown, "" for nothing
std::string error_in(const std::function<void()>& work);

/// Does work on rank 0 that may fail there. Collective.
/// @throws std::invalid_argument on all ranks if it does
void run_on_root(const Communicator& ranks, const std::function<void()>& work);

/// Tags keep messages of different kinds apart.
enum class MessageTag {
  EXCHANGE = 1,
  CHAIN,    ///< passes along a chain of ranks, one by one
  TEXT,     ///< on its way to rank 0
  REQUEST,  ///< for the next chunk of a work queue
  CHUNK     ///< of a work queue
};

/// Messages under way, of any size: they are sent in parts, as MPI counts in int.
class Transfer {
 public:
  explicit Transfer(const Communicator& ranks, MessageTag tag = MessageTag::EXCHANGE)
      : ranks_(ranks), tag_(static_cast<int>(tag)) {}
  void send(std::size_t to, const void* data, std::size_t bytes);
  void receive(std::size_t from, void* data, std::size_t bytes);
  void finish();

 private:
  const Communicator& ranks_;
  int tag_;
  std::vector<MPI_Request> requests_;
};

/// Messages from each rank to each, under way while ranks do other things. Exchanges that overlap
/// are started in the same order on all ranks.
template <class T>
class Exchange {
  static_assert(is_sendable<T>);

 public:
  explicit Exchange(const Communicator& ranks) : ranks_(ranks), transfer_(ranks) {}

  /// Begins to send what is for each rank. Collective.
  void start(PerRank<T> to) {
    to_ = std::move(to);
    std::vector<std::uint64_t> counts(to_.size());
    for (std::size_t i = 0; i < to_.size(); ++i) {
      counts[i] = to_[i].size();
    }
    counts = ranks_.exchange_counts(counts);
    from_.resize(to_.size());
    const auto here = static_cast<std::size_t>(ranks_.rank());
    from_[here] = std::move(to_[here]);
    for (std::size_t i = 0; i < to_.size(); ++i) {
      if (i != here) {
        from_[i].resize(counts[i]);
        transfer_.receive(i, from_[i].data(), from_[i].size() * sizeof(T));
      }
    }
    for (std::size_t i = 0; i < to_.size(); ++i) {
      if (i != here) {
        transfer_.send(i, to_[i].data(), to_[i].size() * sizeof(T));
      }
    }
  }

  /// Waits for what is for this rank; none if nothing was started.
  PerRank<T> finish() {
    transfer_.finish();
    to_.clear();
    return std::move(from_);
  }

 private:
  const Communicator& ranks_;
  Transfer transfer_;
  PerRank<T> to_;
  PerRank<T> from_;
};

template <class T>
PerRank<T> Communicator::exchange(PerRank<T> to) const {
  Exchange<T> exchange(*this);
  exchange.start(std::move(to));
  return exchange.finish();
}

}  // namespace fiber

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

/// For each rank what is sent to it, or what came from it.
template <class T>
using PerRank = std::vector<std::vector<T>>;

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

  /// Ends what cannot go on, on all ranks alike.
  /// @param error of this rank, "" for none
  /// @throws std::invalid_argument on every rank if any has an error: that of the lowest of these
  void throw_on_all(const std::string& error) const;

  bool all(bool value) const;
  double min(double value) const;
  double max(double value) const;
  std::uint64_t sum(std::uint64_t value) const;

  /// Of each rank its value.
  template <class T>
  std::vector<T> gather_all(const T& value) const {
    static_assert(std::is_trivially_copyable_v<T>);
    std::vector<T> values(static_cast<std::size_t>(size_));
    MPI_Allgather(&value, sizeof(T), MPI_BYTE, values.data(), sizeof(T), MPI_BYTE, ranks_);
    return values;
  }

  /// Of rank 0 its value.
  template <class T>
  T broadcast(T value) const {
    static_assert(std::is_trivially_copyable_v<T>);
    MPI_Bcast(&value, sizeof(T), MPI_BYTE, 0, ranks_);
    return value;
  }

  /// The same of a list.
  template <class T>
  std::vector<T> broadcast(std::vector<T> values) const {
    static_assert(std::is_trivially_copyable_v<T>);
    values.resize(broadcast<std::uint64_t>(values.size()));
    broadcast(values.data(), values.size() * sizeof(T));
    return values;
  }

  /// Sends what is for each rank, and takes what is for this one.
  template <class T>
  PerRank<T> exchange(PerRank<T> to) const;

  /// What each rank has for this one of what this one has for it. Only counts go to all ranks.
  std::vector<std::uint64_t> exchange_counts(const std::vector<std::uint64_t>& counts) const {
    std::vector<std::uint64_t> received(counts.size());
    MPI_Alltoall(counts.data(), 1, MPI_UINT64_T, received.data(), 1, MPI_UINT64_T, ranks_);
    return received;
  }

 private:
  void broadcast(void* data, std::size_t bytes) const;

  MPI_Comm ranks_ = MPI_COMM_NULL;
  int rank_ = 0;
  int size_ = 1;
};

/// @return what was thrown, "" for nothing
std::string error_in(const std::function<void()>& work);

/// Does on rank 0 what may go wrong there. Collective.
/// @throws std::invalid_argument on all ranks if it does
void run_on_root(const Communicator& ranks, const std::function<void()>& work);

/// Messages under way. Those of any size: MPI counts in int.
class Transfer {
 public:
  explicit Transfer(const Communicator& ranks) : ranks_(ranks) {}
  void send(std::size_t to, const void* data, std::size_t bytes);
  void receive(std::size_t from, void* data, std::size_t bytes);
  void finish();

 private:
  const Communicator& ranks_;
  std::vector<MPI_Request> requests_;
};

/// What goes from each rank to each while they do other things. Exchanges that overlap are started
/// in the same order on all ranks.
template <class T>
class Exchange {
  static_assert(std::is_trivially_copyable_v<T>);

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

/// Messages that pass along a chain of ranks, one by one, apart from those of exchange().
constexpr int chain_tag = 2;

/// Text on its way to rank 0.
constexpr int text_tag = 3;

/// What ranks ask rank 0 for, and get of it, while work is dealt out.
constexpr int wish_tag = 4;
constexpr int share_tag = 5;

}  // namespace fiber

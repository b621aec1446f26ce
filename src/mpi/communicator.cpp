#include "src/mpi/communicator.hpp"

#include <algorithm>
#include <exception>
#include <stdexcept>

namespace fiber {
namespace {

/// Calls with each part of a message: call(where it begins, how many bytes it has).
template <class Byte, class Call>
void for_each_part(Byte* data, std::size_t bytes, const Call& call) {
  constexpr std::size_t max_bytes = std::size_t{1} << 28U;
  for (std::size_t done = 0; done < bytes; done += max_bytes) {
    call(data + done, static_cast<int>(std::min(max_bytes, bytes - done)));
  }
}

void require_running_mpi() {
  int is_running = 0;
  int is_over = 0;
  MPI_Initialized(&is_running);
  MPI_Finalized(&is_over);
  if (is_running == 0 || is_over != 0) {
    throw std::logic_error(
        "MPI is not running: call MPI_Init_thread() before, MPI_Finalize() after");
  }
  int support = MPI_THREAD_SINGLE;
  MPI_Query_thread(&support);
  if (support < MPI_THREAD_FUNNELED) {
    throw std::logic_error(
        "MPI was started without thread support: call MPI_Init_thread() with MPI_THREAD_FUNNELED "
        "or more");
  }
}

}  // namespace

Communicator::Communicator(MPI_Comm ranks) {
  require_running_mpi();
  MPI_Comm_dup(ranks, &ranks_);
  MPI_Comm_rank(ranks_, &rank_);
  MPI_Comm_size(ranks_, &size_);
}

Communicator::~Communicator() {
  int is_over = 0;
  MPI_Finalized(&is_over);
  if (is_over == 0) {
    MPI_Comm_free(&ranks_);
  }
}

void Communicator::throw_on_all(const std::string& error) const {
  const int mine = error.empty() ? size_ : rank_;
  int first = size_;
  MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, ranks_);
  if (first == size_) {
    return;
  }
  std::string text = error;
  auto length = static_cast<int>(std::min<std::size_t>(text.size(), 4096));
  MPI_Bcast(&length, 1, MPI_INT, first, ranks_);
  text.resize(static_cast<std::size_t>(length));
  MPI_Bcast(text.data(), length, MPI_CHAR, first, ranks_);
  throw std::invalid_argument("rank " + std::to_string(first) + ": " + text);
}

bool Communicator::all(bool value) const {
  const int mine = value ? 1 : 0;
  int smallest = 0;
  MPI_Allreduce(&mine, &smallest, 1, MPI_INT, MPI_MIN, ranks_);
  return smallest != 0;
}

double Communicator::min(double value) const {
  double smallest = value;
  MPI_Allreduce(&value, &smallest, 1, MPI_DOUBLE, MPI_MIN, ranks_);
  return smallest;
}

double Communicator::max(double value) const { return -min(-value); }

std::uint64_t Communicator::sum(std::uint64_t value) const {
  std::uint64_t all = 0;
  MPI_Allreduce(&value, &all, 1, MPI_UINT64_T, MPI_SUM, ranks_);
  return all;
}

RankShare Communicator::share(std::uint64_t count) const {
  std::uint64_t before = 0;
  MPI_Exscan(&count, &before, 1, MPI_UINT64_T, MPI_SUM, ranks_);
  return {rank_ == 0 ? 0 : before, sum(count)};  // MPI leaves it open what rank 0 gets
}

void Communicator::broadcast_bytes(void* data, std::size_t bytes) const {
  for_each_part(static_cast<char*>(data), bytes,
                [&](char* part, int size) { MPI_Bcast(part, size, MPI_BYTE, 0, ranks_); });
}

void Transfer::send(std::size_t to, const void* data, std::size_t bytes) {
  for_each_part(static_cast<const char*>(data), bytes, [&](const char* part, int size) {
    MPI_Isend(part, size, MPI_BYTE, static_cast<int>(to), tag_, ranks_.handle(),
              &requests_.emplace_back());
  });
}

void Transfer::receive(std::size_t from, void* data, std::size_t bytes) {
  for_each_part(static_cast<char*>(data), bytes, [&](char* part, int size) {
    MPI_Irecv(part, size, MPI_BYTE, static_cast<int>(from), tag_, ranks_.handle(),
              &requests_.emplace_back());
  });
}

void Transfer::finish() {
  MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  requests_.clear();
}

std::string error_in(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& failure) {
    return *failure.what() == '\0' ? "failed" : failure.what();
  }
  return "";
}

void run_on_root(const Communicator& ranks, const std::function<void()>& work) {
  ranks.throw_on_all(ranks.rank() == 0 ? error_in(work) : "");
}

}  // namespace fiber

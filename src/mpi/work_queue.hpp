#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "src/mpi/communicator.hpp"

namespace fiber {

/// Pieces of work by their numbers: begin … end - 1.
struct WorkRange {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
};

/// Work that is dealt out among ranks while they do it.
struct WorkQueue {
  WorkRange all;
  std::uint64_t max_chunk = 1;  ///< of the numbers, for one rank; at least 1

  /// Does the numbers of a range, on any rank.
  /// @param packed what pack() has made for them on rank 0; nothing on rank 0 itself
  std::function<void(const WorkRange& range, const std::vector<char>& packed)> work = {};

  /// What another rank needs to do a range, made on rank 0; may be left out.
  std::function<std::vector<char>(const WorkRange& range)> pack = {};

  /// Told on rank 0 up to which number all have been dealt out; may be left out.
  std::function<void(std::uint64_t end)> show = {};
};

/// Has each number done once, by the rank that is there for it first: one that comes to the end of
/// a range gets another one from rank 0, which works itself in between. Which rank does what
/// differs from run to run. Collective.
/// @param work the same numbers on all ranks
/// @throws std::invalid_argument on every rank if something is thrown on any, with its number;
///         numbers may be left undone then
void run_work_queue(const Communicator& ranks, const WorkQueue& work);

}  // namespace fiber

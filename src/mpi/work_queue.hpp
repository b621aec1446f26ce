#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "src/mpi/communicator.hpp"

namespace fiber {

/// Work by its numbers: begin … end - 1.
struct WorkRange {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
};

/// Work whose chunks ranks take while they do it.
struct WorkQueue {
  WorkRange all;
  std::uint64_t max_chunk = 1;  ///< numbers that a rank gets at a time, at least 1

  /// Does the numbers of a range, on any rank.
  /// @param packed what pack() has made for them on rank 0; nothing on rank 0 itself
  std::function<void(const WorkRange& range, const std::vector<char>& packed)> work = {};

  /// Packs on rank 0 the data that another rank needs to do a range; may be left out.
  std::function<std::vector<char>(const WorkRange& range)> pack = {};

  /// Told on rank 0 up to which number all have been given away; may be left out.
  std::function<void(std::uint64_t end)> show = {};
};

/// Has each number done once, by the rank that is there for it first: a rank that comes to the end
/// of its chunk gets another one from rank 0, which works itself in between. Which rank does what
/// differs from run to run. Collective.
/// @param queue the same numbers on all ranks
/// @throws std::invalid_argument on every rank if something is thrown on any, with its number;
///         numbers may be left undone then
void run_work_queue(const Communicator& ranks, const WorkQueue& queue);

}  // namespace fiber

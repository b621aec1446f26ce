#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "src/mpi/communicator.hpp"
#include "src/mpi/work_queue.hpp"

namespace fiber {

/// The text that a rank has made of a range of the work.
struct RangeText {
  std::uint64_t begin = 0;
  std::string text;
};

/// Sends texts between the ranks so that those of a rank come before those of the next one.
/// Collective.
/// @param all   the work that was shared out
/// @param texts of this rank, in any order
/// @return the texts that this rank has then, in order
std::vector<RangeText> sort_over_ranks(const Communicator& ranks, const WorkRange& all,
                                       std::vector<RangeText> texts);

}  // namespace fiber

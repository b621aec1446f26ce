#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "src/mpi/communicator.hpp"
#include "src/mpi/work_queue.hpp"

namespace fiber {

/// What a rank writes of a range that it was dealt.
struct RangeText {
  std::uint64_t begin = 0;
  std::string text;
};

/// Deals the texts of all ranks out anew, so that those of a rank come before those of the next.
/// Collective.
/// @param all   that was dealt out
/// @param texts of this rank, in any order
/// @return this rank's, in order
std::vector<RangeText> sort_over_ranks(const Communicator& ranks, const WorkRange& all,
                                       std::vector<RangeText> texts);

}  // namespace fiber

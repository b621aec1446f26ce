#pragma once

#include <functional>
#include <vector>

#include "fiber_proximity/query/contact.hpp"
#include "src/mpi/local_fibers.hpp"

namespace fiber {

/// What a rank has had to do, in any unit.
struct RankLoad {
  double cost = 0.0;                                   ///< of all; 0 if it is not known
  std::function<std::vector<double>()> costs_of_runs;  ///< of each of its own
};

/// About what an update and queries took of a rank: counted, so that what else a machine did makes
/// no difference.
/// @param own    its fibres
/// @param counts of its queries
/// @param inner  contacts among its own, and those across, of its own (a) and others; all live as
///               long as what is returned
RankLoad load_of(const LocalFibers& own, const QueryCounts& counts,
                 const std::vector<Contact>& inner, const std::vector<Contact>& across);

}  // namespace fiber

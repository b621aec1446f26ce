#pragma once

#include "fiber_proximity/export.hpp"

namespace FIBER_PROXIMITY_EXPORT fiber {

/// Makes the engine `cuda_tree` known to make_engine() and engine_names(), for the rest of the
/// process. make_engine() throws std::runtime_error where no GPU serves, saying what was looked
/// for.
///
/// Calls after the first change nothing. Safe from several threads.
void register_cuda_engines();

}  // namespace fiber

#pragma once

#include <hdf5.h>

#include <cstdint>
#include <functional>

#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/mpi/distributed_engine.hpp"

namespace fiber {

// Names of fibres in a file of HDF5.

/// [byte] that names take there.
std::uint64_t size_of_names(const FiberNames& names);

/// Makes the dataset of names on all ranks alike, none of fibres that are called by their numbers.
/// @return what writes them, for one rank to call
std::function<void()> create_names(hid_t place, const FiberNames& names);

/// The names in a file; numbers where there are none.
/// @throws std::runtime_error, std::invalid_argument
FiberNames read_names(hid_t place);

/// Sees that the fibres of a rank have names.
/// @throws std::invalid_argument naming one that has none
void require_names(const DistributedFibers& fibers);

}  // namespace fiber

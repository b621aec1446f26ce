#pragma once

#include <hdf5.h>

#include <cstdint>

#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "src/mpi/frame_datasets.hpp"

namespace fiber {

// Names of fibres in a file of HDF5.

/// [byte] that names take there.
std::uint64_t size_of_names(const FiberNames& names);

/// Adds the dataset of names, which rank 0 writes; none of fibres that are called by their numbers.
/// Collective.
void add_names(FrameDatasets& datasets, hid_t place, const FiberNames& names, bool is_root);

/// The names in a file; numbers where there are none.
/// @throws std::runtime_error, std::invalid_argument
FiberNames read_names(hid_t place);

/// Sees that the fibres of a rank have names.
/// @throws std::invalid_argument naming one that has none
void require_names(const DistributedFibers& fibers);

}  // namespace fiber

#pragma once

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/mpi/distributed_engine.hpp"

namespace fiber {

// Files of HDF5 that all ranks write and read together, each its part. Their layout is that of
// docs/distributed.md, and one of VTKHDF, which ParaView opens.
//
// A file is written under its name and `.part`, and renamed: what has the name is whole. Of a
// recording of many moments, NAME.h5, each frame is a file of its own, NAME.frames/000000.h5 and so
// on; NAME.h5, which comes last, links to them.
//
// All functions are collective, as those of DistributedEngine, and so are constructors. An error of
// one rank is thrown by all, with its number. MPI must be running when they are called, and when an
// object of a class here ends.

/// Whether a file of this name is one of HDF5: it ends in .h5, .hdf5, .hdf or .vtkhdf, in capitals
/// or not.
bool is_hdf5_name(const std::string& path);

struct DistributedFileOptions {
  bool has_frames = false;  ///< whether frames have numbers; without, the file holds exactly one
  /// One line about the file's sources and options: kept with each frame. Frames of another run are
  /// taken up only if it is the same.
  std::string run;
  bool resume = false;  ///< go on after the frames that an earlier run has finished
};

/// Writes a file frame by frame: what the writers of fibres and of contacts have in common.
class DistributedFileWriter {
 public:
  DistributedFileWriter(const DistributedFileWriter&) = delete;
  DistributedFileWriter& operator=(const DistributedFileWriter&) = delete;

  /// How many frames are whole already, of an earlier run: the next one has this index.
  std::size_t done() const;

  /// Call once, after the last frame: only then is there a file of the name.
  /// @throws std::invalid_argument without a frame, and where the file cannot be written
  void finish();

 protected:
  struct State;

  DistributedFileWriter(MPI_Comm ranks, const std::string& path, const char* content,
                        const DistributedFileOptions& options);
  ~DistributedFileWriter();

  std::unique_ptr<State> state_;
};

/// Writes fibres, each rank its parts, in slices.
///
/// In the file, parts stand in the order of ranks, and within a rank as they are brought. Where one
/// begins at the segment, the point and the radius at which the one before it ends, the two become
/// one: a file does not tell how whole fibres in their order were spread over ranks. Closed and
/// joined fibres stay what they are.
class DistributedFiberWriter : public DistributedFileWriter {
 public:
  /// @throws std::invalid_argument where files cannot be written, and where those of an earlier run
  ///         cannot be gone on with
  DistributedFiberWriter(MPI_Comm ranks, const std::string& path,
                         const DistributedFileOptions& options = {});

  /// Writes the next frame: once this returns, it is whole.
  /// @param frame its number, if frames have one
  /// @throws std::invalid_argument for a second frame without numbers, a number of an earlier
  ///         frame, other than one name per part, fibres that fiber_names has none for, a topology
  ///         that is not of these parts, and where the file cannot be written
  void write(std::int64_t frame, const DistributedFibers& fibers);
};

/// Reads fibres, each rank about as many segments; ranks whose number is larger have what comes
/// later. Fibres are cut where that is in the middle of one.
class DistributedFiberReader {
 public:
  /// @throws std::invalid_argument if it is no whole file of fibres
  DistributedFiberReader(MPI_Comm ranks, const std::string& path);
  ~DistributedFiberReader();
  DistributedFiberReader(const DistributedFiberReader&) = delete;
  DistributedFiberReader& operator=(const DistributedFiberReader&) = delete;

  bool has_frames() const;
  std::size_t frame_count() const;

  /// Reads this rank's part of a frame. What is closed or joined is in its topology.
  /// @param index below frame_count()
  /// @return the number of the frame; 0 if frames have none
  /// @throws std::invalid_argument naming what is wrong in the file
  std::int64_t read(std::size_t index, DistributedFibers& fibers) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Writes contacts, sorted by DistributedContact::key() over all ranks: the file is the same for
/// any number of ranks.
class DistributedContactWriter : public DistributedFileWriter {
 public:
  /// @throws std::invalid_argument as DistributedFiberWriter
  DistributedContactWriter(MPI_Comm ranks, const std::string& path,
                           const DistributedFileOptions& options = {});

  /// Writes the next frame: once this returns, it is whole.
  /// @param frame  its number, if frames have one
  /// @param result as from DistributedEngine::query(); sort_over_ranks() has been called for it
  /// @param names  what the fibres are called, by number, the same on all ranks
  /// @throws std::invalid_argument as DistributedFiberWriter::write()
  void write(std::int64_t frame, const DistributedResult& result, const FiberNames& names = {});
};

}  // namespace fiber

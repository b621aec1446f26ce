#pragma once

#include <cstdint>
#include <string>

#include "src/mpi/communicator.hpp"

namespace fiber {

/// Where what is written under a name goes: to what a link leads to, never in the place of a link.
struct WritePlace {
  std::string path;

  /// A file, or nothing so far: it is written aside and gets its name once it is whole. Otherwise a
  /// device, a pipe or a socket, which is written to as it stands.
  bool is_file = true;
};

/// Collective; rank 0 looks.
/// @throws std::invalid_argument for a folder, and for links that lead in a circle
WritePlace write_place(const Communicator& ranks, const std::string& path);

/// How a file is called while it is written.
inline std::string partial_name(const std::string& path) { return path + ".part"; }

/// Makes a file that is there as long as this, if the system can: a disk that is full is known
/// before anything is written, as HDF5 does not survive it. By one rank.
/// @throws FileError
void reserve(const std::string& path, std::uint64_t size);

/// Gives a file that was written aside its name, once it is on the disk. By one rank.
/// @throws FileError
void move_into_place(const std::string& path);

/// Removes what was written aside, if there is anything. By one rank.
void remove_partial(const std::string& path);

}  // namespace fiber

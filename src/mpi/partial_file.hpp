#pragma once

#include <cstdint>
#include <string>

#include "src/mpi/communicator.hpp"

namespace fiber {

/// The target of a file name to write: the one that links lead to, never a link itself.
struct WritePlace {
  std::string path;

  /// Whether the target is a file or does not exist: then a partial file is written, which gets the
  /// name once it is whole. Otherwise it is a device, a pipe or a socket, and is written to
  /// directly.
  bool is_file = true;
};

/// Collective; rank 0 looks.
/// @throws std::invalid_argument for a folder, and for links that lead in a circle
WritePlace write_place(const Communicator& ranks, const std::string& path);

/// The name of a file while it is written.
inline std::string partial_name(const std::string& path) { return path + ".part"; }

/// Makes an existing file so long, if the system can: a full disk is known before anything is
/// written, as HDF5 does not survive it. Called by one rank.
/// @throws FileError
void reserve(const std::string& path, std::uint64_t size);

/// Gives a partial file its name, once it is on the disk. Called by one rank.
/// @throws FileError
void move_into_place(const std::string& path);

/// Removes the partial file, if there is one. Called by one rank.
void remove_partial(const std::string& path);

}  // namespace fiber

#pragma once

#include <cstdint>
#include <string>

namespace fiber {

/// How a file is called while it is written.
inline std::string aside(const std::string& path) { return path + ".part"; }

/// Makes a file that is there as long as this, if the system can: a disk that is full is known
/// before anything is written, as HDF5 does not survive it. By one rank.
/// @throws FileError
void reserve(const std::string& path, std::uint64_t size);

/// Gives a file that was written aside its name, once it is on the disk. By one rank.
/// @throws FileError
void move_into_place(const std::string& path);

/// Removes what was written aside, if there is anything. By one rank.
void remove_aside(const std::string& path);

}  // namespace fiber

#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "src/io/number_array.hpp"

namespace fiber {

/// An array of numpy.
struct NpyArray {
  NumberArray numbers;
  std::vector<std::uint64_t> shape;
  bool is_fortran = false;  ///< the first index runs fastest
};

/// Reads an .npy file, of version 1 to 3.
/// @param bytes stay where they are
/// @throws std::runtime_error that says what is wrong, without the file
NpyArray read_npy(std::string_view bytes);

/// The bytes of an .npy file before its numbers, which stand in C's order, little-endian.
/// @param description such as <f8
std::string npy_header(const std::string& description, const std::vector<std::uint64_t>& shape);

}  // namespace fiber

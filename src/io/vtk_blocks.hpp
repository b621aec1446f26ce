#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "src/io/bytes.hpp"

namespace fiber {

/// How binary arrays stand in an XML file of VTK.
struct VtkEncoding {
  ByteOrder order = ByteOrder::LITTLE;
  bool has_long_counts = false;  ///< of 64 bits, else of 32
  bool is_compressed = false;    ///< by zlib
  bool is_base64 = true;         ///< else the bytes themselves
};

/// The bytes of an array: their number and they, or as many blocks, compressed each, as a header
/// tells.
/// @param text from where the array begins on
/// @throws std::runtime_error that says what is wrong, without the file and the place
std::string decode_array(std::string_view text, const VtkEncoding& encoding);

}  // namespace fiber

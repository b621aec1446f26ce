#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fiber {

/// How compressed bytes are framed.
enum class Deflated {
  ZLIB,  ///< with zlib's header and checksum
  RAW    ///< without, as in zip archives
};

/// Appends what compressed bytes hold.
/// @param size that it must have [byte]; memory is taken only as bytes come out
/// @return what is wrong with the bytes, "" for nothing
std::string inflate(std::string& out, std::string_view bytes, std::uint64_t size, Deflated kind);

}  // namespace fiber

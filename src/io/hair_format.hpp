#pragma once

#include <cstddef>
#include <cstdint>

#include "src/io/bytes.hpp"

namespace fiber::hair_format {

// Files are read and written as they are in memory.
static_assert(native_order == ByteOrder::LITTLE);

constexpr char signature[] = {'H', 'A', 'I', 'R'};

/// The header after the signature.
struct Header {
  std::uint32_t strands = 0;
  std::uint32_t points = 0;
  std::uint32_t flags = 0;
  std::uint32_t default_segments = 0;
  float default_thickness = 0.0F;
  float default_transparency = 0.0F;
  float default_color[3] = {1.0F, 1.0F, 1.0F};
  char information[88] = "written by fiber_proximity, lengths in metres";
};
constexpr std::uint64_t header_size = sizeof(signature) + sizeof(Header);
static_assert(header_size == 128);

// Where errors say that its fields begin [bytes].
constexpr std::uint64_t strand_count_byte = sizeof(signature) + offsetof(Header, strands);
constexpr std::uint64_t point_count_byte = sizeof(signature) + offsetof(Header, points);
constexpr std::uint64_t flags_byte = sizeof(signature) + offsetof(Header, flags);
constexpr std::uint64_t default_segments_byte =
    sizeof(signature) + offsetof(Header, default_segments);
constexpr std::uint64_t default_thickness_byte =
    sizeof(signature) + offsetof(Header, default_thickness);

enum Flag : std::uint32_t {
  SEGMENTS = 1U << 0U,
  POINTS = 1U << 1U,
  THICKNESS = 1U << 2U,
  TRANSPARENCY = 1U << 3U,
  COLOR = 1U << 4U,
  ALL_FLAGS = SEGMENTS | POINTS | THICKNESS | TRANSPARENCY | COLOR
};

}  // namespace fiber::hair_format

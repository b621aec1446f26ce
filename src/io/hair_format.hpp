#pragma once

#include <cstdint>

namespace fiber::hair_format {

constexpr char signature[] = {'H', 'A', 'I', 'R'};

// Where the header's fields begin, and where it ends [bytes].
constexpr std::uint64_t strand_count_byte = 4;
constexpr std::uint64_t point_count_byte = 8;
constexpr std::uint64_t flags_byte = 12;
constexpr std::uint64_t default_segments_byte = 16;
constexpr std::uint64_t default_thickness_byte = 20;
constexpr std::uint64_t information_byte = 40;
constexpr std::uint64_t header_size = 128;

enum Flag : std::uint32_t {
  SEGMENTS = 1U << 0U,
  POINTS = 1U << 1U,
  THICKNESS = 1U << 2U,
  TRANSPARENCY = 1U << 3U,
  COLOR = 1U << 4U,
  ALL_FLAGS = SEGMENTS | POINTS | THICKNESS | TRANSPARENCY | COLOR
};

}  // namespace fiber::hair_format

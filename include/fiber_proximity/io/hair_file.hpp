#pragma once

#include <iosfwd>
#include <string>

#include "fiber_proximity/io/fiber_frame.hpp"
#include "fiber_proximity/io/file_error.hpp"

namespace fiber {

// The HAIR format of Cem Yuksel (www.cemyuksel.com/research/hairmodels). All numbers are
// little-endian. A header of 128 bytes: "HAIR", then at these bytes
//    4 number of strands, 8 number of points, 12 flags, 16 default segments (uint32),
//   20 default thickness, 24 default transparency, 28 default colour (1, 1 and 3 float32),
//   40 information for people (88 bytes);
// then the arrays that the flags announce, in this order:
//   bit 0 segments of each strand (uint16), bit 1 points (3 float32), bit 2 thickness,
//   bit 3 transparency (float32 each), bit 4 colour (3 float32), all of them per point.
// The format states no unit of length: numbers are taken as metres.

/// Reads a .hair file as one frame without a number. The strands become fibres in the file's order;
/// half of a thickness is a radius. Transparency and colour have no place in an assembly.
/// @param default_radius [m] of all fibres if the file has neither a thickness array nor a default
///        thickness other than 0
/// @throws FileError naming the field and its byte; also for a strand of 0 segments, which would be
///         a fibre of one point, and for bytes that the header does not account for. The header is
///         compared with the size of the file before anything is allocated by it.
/// @throws std::invalid_argument for a bad default_radius
FiberFile read_hair(const std::string& path, double default_radius = 0.0);

/// The same from a stream, which must be able to seek; errors call it by `name`.
FiberFile read_hair(std::istream& stream, const std::string& name, double default_radius = 0.0);

/// Writes a .hair file. Coordinates and radii are rounded to single precision, all that the format
/// has. The arrays of segments and thickness are written only if one value does not serve all.
/// @throws FileError
/// @throws std::invalid_argument if a file cannot hold this: anything but one frame without a
///         number, fibres that differ in segments and have more than 65 535 of them, or numbers
///         beyond single precision
void write_hair(const std::string& path, const FiberFile& file);

/// The same to a stream, which is not checked for errors.
void write_hair(std::ostream& stream, const FiberFile& file);

}  // namespace fiber

#pragma once

#include <iosfwd>
#include <string>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/io/fiber_file.hpp"

// Formats of other programs, each of one frame without a number and without names. Readers take a
// stream that can seek; errors call it by `name` and tell the byte or the line, and nothing is
// allocated by a count that the stream cannot hold. Writers take a stream that they do not check
// for errors.

namespace FIBER_PROXIMITY_EXPORT fiber {

// ---- tractograms: streamlines of diffusion MRI. Their coordinates are in millimetres, those of
// FiberAssembly in metres: reading divides by 1000, writing multiplies.

/// Reads a .tck file of MRtrix: a text header, then points of Float32 or Float64, little-endian or
/// big-endian, with three NaN after each track and three infinities at the end.
/// @throws FileError also where the header's count is not that of the tracks
/// @throws std::invalid_argument for a bad default radius
FiberFile read_tck(std::istream& stream, const std::string& name, const ReadOptions& options = {});

/// Writes a .tck file in single precision, little-endian. Radii have no place in it.
/// @throws std::invalid_argument if the file cannot hold this: anything but one frame without a
///         number, or numbers beyond single precision
void write_tck(std::ostream& stream, const FiberFile& file);

/// Reads a .trk file of TrackVis, little-endian or big-endian. Points count from the corner of the
/// first voxel in the axes of `voxel_order`; they are brought into the space of `vox_to_ras` (as
/// (point / voxel_size - 0.5), axes flipped where the two differ), or stay where they are in a file
/// that has no such matrix, which a note tells. A scalar named radius is the radius of a point
/// [mm]; notes name all other scalars and properties.
/// @throws FileError
/// @throws std::invalid_argument for a bad default radius
FiberFile read_trk(std::istream& stream, const std::string& name, const ReadOptions& options = {});

/// Writes a .trk file in single precision, little-endian, with voxels of 1 mm. Radii, unless all
/// are 0, are a scalar named radius [mm].
/// @throws std::invalid_argument as write_tck()
void write_trk(std::ostream& stream, const FiberFile& file);

// ---- VTK's poly data, whose lines are the fibres. It states no unit of length: numbers are taken
// as metres. An array of the points named radius or TubeRadius, in capitals or not, holds radii;
// notes name all other arrays, and count cells that are no lines and points that are in none.

/// Reads a .vtp file, VTK's XML: arrays as text, base64 or appended, compressed by zlib or not,
/// little-endian or big-endian, of all pieces. write_vtp() writes one.
/// @throws FileError also for points without any line
/// @throws std::invalid_argument for a bad default radius
FiberFile read_vtp(std::istream& stream, const std::string& name, const ReadOptions& options = {});

/// Reads a .vtk file, VTK's legacy format, of versions 1 to 5, ASCII or BINARY.
/// @throws FileError also for points without any line
/// @throws std::invalid_argument for a bad default radius
FiberFile read_vtk(std::istream& stream, const std::string& name, const ReadOptions& options = {});

// ---- others

/// Reads an .npz file, an archive of numpy's arrays, stored or deflated (numpy.savez,
/// numpy.savez_compressed): `points` (number of points, 3) [m], `offsets` as those of
/// FiberAssembly, and where there are any `radii` (one, one per fibre or one per point) [m],
/// `closed` (per fibre) and `joints` (per point) as FiberTopology has them. Notes name all other
/// arrays.
/// @throws FileError
/// @throws std::invalid_argument for a bad default radius
FiberFile read_npz(std::istream& stream, const std::string& name, const ReadOptions& options = {});

/// Writes an .npz file, stored, in double precision: all numbers read back as the same.
/// @throws std::invalid_argument if the file cannot hold this: anything but one frame without a
///         number, or 4 GiB and more
void write_npz(std::ostream& stream, const FiberFile& file);

/// Reads an .swc file, trees of neurons, whose lengths are micrometres: reading divides by 1e6.
/// Each unbranched part is a fibre, and where several meet is a joint. Points of the soma (type 1)
/// are left out, with a note, and neurites begin at their first point of another type.
/// @throws FileError naming the line, also for parents that are missing or among their own
///         descendants
/// @throws std::invalid_argument for a bad default radius
FiberFile read_swc(std::istream& stream, const std::string& name, const ReadOptions& options = {});

}  // namespace fiber

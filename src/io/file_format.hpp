#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "fiber_proximity/export.hpp"

namespace fiber {

/// Formats of files with fibres, and of tables about them.
enum class FileFormat {
  CSV,
  HAIR,  ///< one frame, as all of other programs
  TCK,
  TRK,
  NPZ,
  SWC,    ///< read only
  VTK,    ///< of poly data, read only
  VTP,    ///< of ParaView
  PVD,    ///< for ParaView, written only
  HDF5,   ///< by the tools that run over ranks
  JSON,   ///< answers only
  OTHER,  ///< that is neither read nor written
};

/// The format that a name means by its end, in capitals or not; nothing by most ends, and by none.
FIBER_PROXIMITY_EXPORT std::optional<FileFormat> format_meant(const std::string& path);

/// The format that a name means by its end; CSV where it means nothing.
FIBER_PROXIMITY_EXPORT FileFormat format_of(const std::string& path);

/// The format of a file with a name of CSV, by its first bytes, for an error; "" if they are none
/// that are known.
std::string format_of_content(std::string_view begin);

/// Whether a format is written here and holds one frame.
FIBER_PROXIMITY_EXPORT bool holds_one_frame(FileFormat format);

/// Sees that fibres can be read from a file of this name here, without ranks.
/// @throws FileError
void require_format_to_read(const std::string& path);

/// Sees that fibres can be written to one.
/// @throws std::invalid_argument
void require_format_to_write(const std::string& path);

/// Sees that a name does not mean another format than the one that is written; "" means nothing.
/// @param what is called so, such as an option
/// @throws std::invalid_argument
FIBER_PROXIMITY_EXPORT void require_format(FileFormat format, const std::string& what,
                                           const std::string& path);

}  // namespace fiber

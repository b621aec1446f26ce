#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fiber {

/// Where the columns of a file of points stand, as its header says.
struct CsvColumns {
  enum Column { FRAME, FIBER, X, Y, Z, RADIUS, CLOSED, JOINT, COLUMNS };

  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  /// Names the expected columns, as an error does.
  static constexpr const char* rule =
      "expected the columns x, y, z, if any frame, fiber, radius, closed, joint (or a name that "
      "ends "
      "as its format)";

  char separator = ',';
  std::size_t count = 0;                    ///< of all columns
  std::array<std::size_t, COLUMNS> places;  ///< by Column; none where there is none
  std::vector<std::string> others;          ///< those that mean nothing here, but for unnamed ones
  std::string twice;                        ///< a column that is there twice, "" for none

  bool has(Column column) const { return places[column] != none; }
};

/// Reads a header: names in any order, in capitals or not.
/// @return nothing if it has no x, y or z, whatever separates its names
std::optional<CsvColumns> columns_in(std::string_view header);

}  // namespace fiber

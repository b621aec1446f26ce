#pragma once

#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "fiber_proximity/io/file.hpp"

namespace fiber {

/// [byte] The longest line and the longest field of a text file: what is longer is another kind of
/// file, or has no end, and is refused before memory is.
constexpr std::size_t longest_line = 65'536;
constexpr std::size_t longest_field = 4'096;

/// @throws FileError
std::ifstream open_to_read(const std::string& path);

/// Gives lines one after another, the first without the byte order mark that spreadsheets write.
class LineReader {
 public:
  /// @param name what errors call the stream
  LineReader(std::istream& stream, std::string name);

  /// Whether there is a line; it stays until the next one is read.
  /// @throws FileError for a line that is longer than longest_line or cannot be read
  bool next(std::string_view& line);

 private:
  std::istream& stream_;
  const std::string name_;
  std::size_t line_ = 0;
  std::vector<char> buffer_;
};

/// Calls take(line) with each line.
/// @throws FileError as LineReader
template <class Take>
void for_each_line(std::istream& stream, const std::string& name, const Take& take) {
  LineReader reader(stream, name);
  for (std::string_view line; reader.next(line);) {
    take(line);
  }
}

/// @throws FileError for a field that is longer than longest_field
void check_fields(const std::vector<std::string_view>& fields, const std::string& name,
                  std::size_t line);

}  // namespace fiber

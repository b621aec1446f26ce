#include "src/io/bytes.hpp"

#include <cerrno>
#include <istream>

#include "fiber_proximity/io/file.hpp"
#include "src/io/number.hpp"

namespace fiber {

std::string at_byte(std::uint64_t byte) { return " (byte " + text_of(byte) + ")"; }

std::string read_bytes(std::istream& stream, const std::string& name, const char* format) {
  errno = 0;
  const auto end = stream.seekg(0, std::ios::end).tellg();
  stream.clear();
  stream.seekg(0);
  if (!stream || end < 0) {
    throw FileError(name,
                    std::string("does not tell its size, ") + format + " must be an ordinary file");
  }
  stream.peek();  // a folder tells a size, which is beyond that of any file, and fails here
  if (stream.bad()) {
    throw FileError::from_system(name, "cannot be read");
  }
  stream.clear();
  std::string bytes(static_cast<std::size_t>(end), '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (stream.bad()) {
    throw FileError::from_system(name, "cannot be read");
  }
  bytes.resize(static_cast<std::size_t>(stream.gcount()));
  return bytes;
}

std::string_view ByteReader::take(std::uint64_t count) {
  if (count > left()) {
    throw FileError(name_, "ends at byte " + text_of(std::uint64_t{bytes_.size()}));
  }
  const std::string_view taken = bytes_.substr(position_, count);
  position_ += count;
  return taken;
}

}  // namespace fiber

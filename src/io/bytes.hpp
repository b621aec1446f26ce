#pragma once

#include <algorithm>
#include <boost/endian/conversion.hpp>
#include <cstdint>
#include <cstring>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

#include "fiber_proximity/export.hpp"

namespace fiber {

/// In which order the bytes of a number stand in a file.
enum class ByteOrder { LITTLE, BIG };

constexpr ByteOrder native_order = boost::endian::order::native == boost::endian::order::little
                                       ? ByteOrder::LITTLE
                                       : ByteOrder::BIG;

constexpr ByteOrder other_order(ByteOrder order) {
  return order == ByteOrder::LITTLE ? ByteOrder::BIG : ByteOrder::LITTLE;
}

/// The number that stands at these bytes, sizeof(Value) of them.
template <class Value>
Value value_at(const char* bytes, ByteOrder order) {
  char ordered[sizeof(Value)];
  std::memcpy(ordered, bytes, sizeof(Value));
  if (order != native_order) {
    std::reverse(ordered, ordered + sizeof(Value));
  }
  Value value;
  std::memcpy(&value, ordered, sizeof(Value));
  return value;
}

/// Appends the bytes of a number, in the little-endian order that all formats are written in.
template <class Value>
void append_value(std::string& bytes, Value value) {
  static_assert(native_order == ByteOrder::LITTLE);
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

/// Where an error says that something begins.
std::string at_byte(std::uint64_t byte);

/// All bytes of a stream, which must be able to seek: what a file claims to hold is compared with
/// its size before memory is allocated.
/// @param name   what errors call the stream
/// @param format what it holds, for errors: "a HAIR file"
/// @throws FileError
std::string read_bytes(std::istream& stream, const std::string& name, const char* format);

/// Takes values from the bytes of a file, one after another, and knows where in the file it is.
class ByteReader {
 public:
  /// @param bytes from the file's beginning on; they and the name stay where they are
  ByteReader(std::string_view bytes, const std::string& name, std::uint64_t position = 0)
      : bytes_(bytes), name_(name), position_(position) {}

  std::uint64_t position() const { return position_; }
  std::uint64_t left() const { return bytes_.size() - position_; }

  /// The next bytes.
  /// @throws FileError if there are fewer
  std::string_view take(std::uint64_t count);

  template <class Value>
  Value value(ByteOrder order = ByteOrder::LITTLE) {
    return value_at<Value>(take(sizeof(Value)).data(), order);
  }

 private:
  const std::string_view bytes_;
  const std::string& name_;
  std::uint64_t position_;
};

}  // namespace fiber

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "src/io/bytes.hpp"

namespace fiber {

/// Types of numbers in files.
enum class NumberType {
  INT8,
  UINT8,
  INT16,
  UINT16,
  INT32,
  UINT32,
  INT64,
  UINT64,
  FLOAT32,
  FLOAT64
};

std::size_t size_of(NumberType type);
bool is_whole(NumberType type);

/// Numbers of one type as they stand in a file.
class NumberArray {
 public:
  NumberArray() = default;

  /// @param bytes stay where they are
  NumberArray(NumberType type, ByteOrder order, std::string_view bytes)
      : type_(type), order_(order), bytes_(bytes) {}

  NumberType type() const { return type_; }
  std::size_t size() const { return bytes_.size() / size_of(type_); }

  double real(std::size_t index) const;

  /// @pre is_whole(type())
  /// @return of a number beyond the type, the largest one
  std::int64_t whole(std::size_t index) const;

 private:
  NumberType type_ = NumberType::FLOAT64;
  ByteOrder order_ = native_order;
  std::string_view bytes_;
};

/// Appends the numbers of a text, separated by blanks and line ends, as they are in memory: of
/// FLOAT64, or of INT64 where the type is a whole one.
/// @return the first word that is no such number
std::optional<std::string_view> append_numbers(std::string& bytes, NumberType type,
                                               std::string_view text);

/// The type of what append_numbers() appends.
inline NumberType type_in_memory(NumberType type) {
  return is_whole(type) ? NumberType::INT64 : NumberType::FLOAT64;
}

/// Takes the next word off a text; empty at its end.
std::string_view take_word(std::string_view& text);

}  // namespace fiber

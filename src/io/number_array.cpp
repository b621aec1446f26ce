#include "src/io/number_array.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

#include "src/io/number.hpp"

namespace fiber {
namespace {

/// Calls use() with the number that stands at these bytes.
template <class Use>
auto with_number(NumberType type, ByteOrder order, const char* bytes, const Use& use) {
  switch (type) {
    case NumberType::INT8:
      return use(value_at<std::int8_t>(bytes, order));
    case NumberType::UINT8:
      return use(value_at<std::uint8_t>(bytes, order));
    case NumberType::INT16:
      return use(value_at<std::int16_t>(bytes, order));
    case NumberType::UINT16:
      return use(value_at<std::uint16_t>(bytes, order));
    case NumberType::INT32:
      return use(value_at<std::int32_t>(bytes, order));
    case NumberType::UINT32:
      return use(value_at<std::uint32_t>(bytes, order));
    case NumberType::INT64:
      return use(value_at<std::int64_t>(bytes, order));
    case NumberType::UINT64:
      return use(value_at<std::uint64_t>(bytes, order));
    case NumberType::FLOAT32:
      return use(value_at<float>(bytes, order));
    case NumberType::FLOAT64:
      break;
  }
  return use(value_at<double>(bytes, order));
}

}  // namespace

std::size_t size_of(NumberType type) {
  switch (type) {
    case NumberType::INT8:
    case NumberType::UINT8:
      return 1;
    case NumberType::INT16:
    case NumberType::UINT16:
      return 2;
    case NumberType::INT32:
    case NumberType::UINT32:
    case NumberType::FLOAT32:
      return 4;
    default:
      return 8;
  }
}

bool is_whole(NumberType type) {
  return type != NumberType::FLOAT32 && type != NumberType::FLOAT64;
}

double NumberArray::real(std::size_t index) const {
  assert(index < size());
  return with_number(type_, order_, bytes_.data() + index * size_of(type_),
                     [](auto value) { return static_cast<double>(value); });
}

std::int64_t NumberArray::whole(std::size_t index) const {
  assert(index < size() && is_whole(type_));
  return with_number(type_, order_, bytes_.data() + index * size_of(type_), [](auto value) {
    constexpr std::int64_t largest = std::numeric_limits<std::int64_t>::max();
    if constexpr (std::is_same_v<decltype(value), std::uint64_t>) {
      return static_cast<std::int64_t>(std::min(value, static_cast<std::uint64_t>(largest)));
    } else {
      return static_cast<std::int64_t>(value);
    }
  });
}

std::string_view take_word(std::string_view& text) {
  constexpr const char* white_space = " \t\r\n\f\v";
  text.remove_prefix(std::min(text.size(), text.find_first_not_of(white_space)));
  const std::string_view word = text.substr(0, text.find_first_of(white_space));
  text.remove_prefix(word.size());
  return word;
}

std::optional<std::string_view> append_numbers(std::string& bytes, NumberType type,
                                               std::string_view text) {
  for (std::string_view word = take_word(text); !word.empty(); word = take_word(text)) {
    if (is_whole(type)) {
      const std::optional<std::int64_t> value = parse_number<std::int64_t>(word);
      if (!value) {
        return word;
      }
      append_value(bytes, *value);
    } else {
      const std::optional<double> value = parse_number<double>(word);
      if (!value) {
        return word;
      }
      append_value(bytes, *value);
    }
  }
  return std::nullopt;
}

}  // namespace fiber

// .npy files: numpy.org/doc/stable/reference/generated/numpy.lib.format.html
#include "src/io/npy_array.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "src/io/number.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

constexpr std::string_view npy_signature{"\x93NUMPY", 6};

/// The value of a key in the header, which is a dictionary as Python writes it, up to the comma or
/// bracket that ends it.
std::string_view value_in(std::string_view header, const std::string& key) {
  const std::size_t found = header.find('\'' + key + "':");
  if (found == std::string_view::npos) {
    throw std::runtime_error("the header has no " + key + ": " + quote(header));
  }
  header.remove_prefix(found + key.size() + 3);
  header.remove_prefix(std::min(header.size(), header.find_first_not_of(' ')));
  const bool is_tuple = !header.empty() && header.front() == '(';
  return header.substr(0, is_tuple ? header.find(')') : header.find_first_of(",}"));
}

std::vector<std::uint64_t> shape_in(std::string_view text) {
  std::vector<std::uint64_t> shape;
  std::string_view rest = text.substr(std::min<std::size_t>(1, text.size()));
  while (!rest.empty()) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    std::string_view word = rest.substr(0, comma);
    rest.remove_prefix(std::min(comma + 1, rest.size()));
    std::string_view number = take_word(word);
    if (number.empty() && rest.find_first_not_of(' ') == std::string_view::npos) {
      break;  // after the comma of a tuple of one
    }
    const auto value = parse_number<std::uint64_t>(number);
    if (!value || shape.size() > 2) {
      throw std::runtime_error("the shape is " + quote(text) + ", expected up to three numbers");
    }
    shape.push_back(*value);
  }
  return shape;
}

std::pair<NumberType, ByteOrder> type_in(std::string_view text) {
  constexpr std::pair<std::string_view, NumberType> types[] = {
      {"i1", NumberType::INT8},    {"u1", NumberType::UINT8},  {"b1", NumberType::UINT8},
      {"i2", NumberType::INT16},   {"u2", NumberType::UINT16}, {"i4", NumberType::INT32},
      {"u4", NumberType::UINT32},  {"i8", NumberType::INT64},  {"u8", NumberType::UINT64},
      {"f4", NumberType::FLOAT32}, {"f8", NumberType::FLOAT64}};
  if (text.size() == 5 && text.front() == '\'' && text.back() == '\'') {
    const char order = text[1];
    for (const auto& [known, type] : types) {
      if (text.substr(2, 2) == known && (order == '<' || order == '>' || order == '|')) {
        return {type, order == '>' ? ByteOrder::BIG : ByteOrder::LITTLE};
      }
    }
  }
  throw std::runtime_error("the type (descr) is " + quote(text) +
                           ", expected whole numbers or those of 4 or 8 bytes");
}

}  // namespace

NpyArray read_npy(std::string_view bytes) {
  if (bytes.substr(0, npy_signature.size()) != npy_signature || bytes.size() < 12) {
    throw std::runtime_error("it is no array of numpy");
  }
  const char major = bytes[6];
  if (major < 1 || major > 3) {
    throw std::runtime_error("its version is " + text_of(static_cast<int>(major)) +
                             ", expected 1 to 3");
  }
  const std::size_t begin = major == 1 ? 10 : 12;
  const std::uint64_t size = major == 1 ? value_at<std::uint16_t>(&bytes[8], ByteOrder::LITTLE)
                                        : value_at<std::uint32_t>(&bytes[8], ByteOrder::LITTLE);
  if (size > bytes.size() - begin) {
    throw std::runtime_error("its header has " + text_of(size) + " bytes, there are " +
                             text_of(std::uint64_t{bytes.size() - begin}));
  }
  const std::string_view header = bytes.substr(begin, size);
  bytes.remove_prefix(begin + size);
  NpyArray array;
  array.shape = shape_in(value_in(header, "shape"));
  array.is_fortran = value_in(header, "fortran_order").substr(0, 4) == "True";
  const auto [type, order] = type_in(value_in(header, "descr"));
  std::uint64_t count = 1;
  for (const std::uint64_t length : array.shape) {
    if (length > 0 && count > bytes.size() / length) {
      throw std::runtime_error("the shape is " + quote(value_in(header, "shape")) + "), in " +
                               text_of(std::uint64_t{bytes.size()}) + " bytes");
    }
    count *= length;
  }
  if (bytes.size() != count * size_of(type)) {
    throw std::runtime_error("it has " + text_of(std::uint64_t{bytes.size()}) +
                             " bytes of numbers, " + text_of(count * size_of(type)) + " are told");
  }
  array.numbers = NumberArray(type, order, bytes);
  return array;
}

std::string npy_header(const std::string& description, const std::vector<std::uint64_t>& shape) {
  std::string text = "{'descr': '" + description + "', 'fortran_order': False, 'shape': (";
  for (const std::uint64_t length : shape) {
    text += text_of(length) + ",";
  }
  text += "), }";
  constexpr std::size_t begin = 10;
  constexpr std::size_t alignment = 64;  // of the numbers
  while ((begin + text.size() + 1) % alignment != 0) {
    text += ' ';
  }
  text += '\n';
  std::string bytes(npy_signature);
  bytes += '\1';
  bytes += '\0';
  append_value(bytes, static_cast<std::uint16_t>(text.size()));
  return bytes + text;
}

}  // namespace fiber

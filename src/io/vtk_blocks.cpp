#include "src/io/vtk_blocks.hpp"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "src/io/inflate.hpp"
#include "src/io/number.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

/// Gives bytes one after another, out of base64 or as they stand.
class EncodedBytes {
 public:
  EncodedBytes(std::string_view text, bool is_base64) : text_(text), is_base64_(is_base64) {}

  /// At most how many bytes are left.
  std::uint64_t left() const {
    return is_base64_ ? ready_.size() + 3 * (text_.size() / 4 + 1) : text_.size();
  }

  std::string take(std::uint64_t count) {
    if (count > left()) {
      throw std::runtime_error("ends after " + text_of(left()) + " of " + text_of(count) +
                               " bytes");
    }
    std::string bytes;
    if (!is_base64_) {
      bytes = text_.substr(0, count);
      text_.remove_prefix(count);
      return bytes;
    }
    bytes.reserve(count);
    bytes.swap(ready_);
    while (bytes.size() < count) {
      take_quantum(bytes, count);
    }
    ready_ = bytes.substr(count);
    bytes.resize(count);
    return bytes;
  }

 private:
  /// Four letters of base64 are up to three bytes; fewer end a run, after which another may begin.
  void take_quantum(std::string& bytes, std::uint64_t count) {
    std::uint32_t bits = 0;
    int letters = 0;
    int padding = 0;
    while (letters + padding < 4) {
      if (text_.empty()) {
        throw std::runtime_error("ends after " + text_of(std::uint64_t{bytes.size()}) + " of " +
                                 text_of(count) + " bytes");
      }
      const char letter = text_.front();
      text_.remove_prefix(1);
      if (letter == ' ' || letter == '\n' || letter == '\t' || letter == '\r') {
        continue;
      }
      const int value = value_of(letter);
      if (letter == '=' ? letters < 2 : value < 0 || padding > 0) {
        throw std::runtime_error("has " + quote(std::string(1, letter)) + ", which is no base64");
      }
      (letter == '=' ? padding : letters) += 1;
      bits = bits << 6U | static_cast<std::uint32_t>(std::max(value, 0));
    }
    for (int byte = 0; byte < letters - 1; ++byte) {
      bytes += static_cast<char>(bits >> (16U - 8U * static_cast<unsigned>(byte)) & 0xffU);
    }
  }

  static int value_of(char letter) {
    return letter >= 'A' && letter <= 'Z'   ? letter - 'A'
           : letter >= 'a' && letter <= 'z' ? letter - 'a' + 26
           : letter >= '0' && letter <= '9' ? letter - '0' + 52
           : letter == '+'                  ? 62
           : letter == '/'                  ? 63
                                            : -1;
  }

  std::string_view text_;
  const bool is_base64_;
  std::string ready_;  // decoded, and not taken yet
};

std::uint64_t take_count(EncodedBytes& bytes, const VtkEncoding& encoding) {
  return encoding.has_long_counts ? value_at<std::uint64_t>(bytes.take(8).data(), encoding.order)
                                  : value_at<std::uint32_t>(bytes.take(4).data(), encoding.order);
}

std::string inflate_blocks(EncodedBytes& bytes, const VtkEncoding& encoding) {
  const std::uint64_t block_count = take_count(bytes, encoding);
  const std::uint64_t block_size = take_count(bytes, encoding);
  const std::uint64_t last_size = take_count(bytes, encoding);  // 0: it is whole
  const std::uint64_t count_size = encoding.has_long_counts ? 8 : 4;
  if (block_count > bytes.left() / count_size) {
    throw std::runtime_error("tells of " + text_of(block_count) + " blocks in " +
                             text_of(bytes.left()) + " bytes");
  }
  std::vector<std::uint64_t> sizes(block_count);  // as they are compressed
  for (std::uint64_t& size : sizes) {
    size = take_count(bytes, encoding);
  }
  std::string out;
  for (std::uint64_t block = 0; block < block_count; ++block) {
    const std::uint64_t size = block + 1 == block_count && last_size > 0 ? last_size : block_size;
    const std::string problem = inflate(out, bytes.take(sizes[block]), size, Deflated::ZLIB);
    if (!problem.empty()) {
      throw std::runtime_error("block " + text_of(block) + " of " + text_of(block_count) + ": " +
                               problem);
    }
  }
  return out;
}

}  // namespace

std::string decode_array(std::string_view text, const VtkEncoding& encoding) {
  EncodedBytes bytes(text, encoding.is_base64);
  return encoding.is_compressed ? inflate_blocks(bytes, encoding)
                                : bytes.take(take_count(bytes, encoding));
}

}  // namespace fiber

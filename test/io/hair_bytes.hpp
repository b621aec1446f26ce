#pragma once

#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"

namespace fiber::test {

using Offsets = std::vector<std::uint32_t>;
using Radii = std::vector<double>;

/// A file put together by hand, apart from the writer.
class Bytes {
 public:
  Bytes& uint(std::uint64_t value, int size) {
    for (int byte = 0; byte < size; ++byte) {
      text_ += static_cast<char>((value >> (8 * byte)) & 0xffU);
    }
    return *this;
  }
  Bytes& floats(const std::vector<float>& values) {
    for (const float value : values) {
      std::uint32_t bits = 0;
      std::memcpy(&bits, &value, sizeof(bits));
      uint(bits, 4);
    }
    return *this;
  }
  Bytes& letters(const std::string& letters) {
    text_ += letters;
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

inline FiberFile parse(const std::string& text, double default_radius = 0.0) {
  std::istringstream stream(text);
  return read_hair(stream, "a.hair", default_radius);
}

inline FiberAssembly fibers_of(const std::string& text, double default_radius = 0.0) {
  return parse(text, default_radius).frames.at(0).fibers;
}

}  // namespace fiber::test

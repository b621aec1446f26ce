#pragma once

#include <iosfwd>
#include <string>

namespace fiber {

/// Text on its way to a stream, written piece by piece: a frame may have millions of lines.
class TextOutput {
 public:
  explicit TextOutput(std::ostream& stream) : stream_(stream) {}

  /// What is to be written next; append to it.
  std::string& text() { return text_; }

  /// Writes the text if it has become long. Call after each line or so.
  /// @throws std::runtime_error if it cannot be written
  void flush_if_long() {
    if (text_.size() >= long_text) {
      flush();
    }
  }

  /// @throws std::runtime_error as flush_if_long
  void flush();

 private:
  static constexpr std::size_t long_text = 65'536;  // [byte]

  std::ostream& stream_;
  std::string text_;
};

}  // namespace fiber

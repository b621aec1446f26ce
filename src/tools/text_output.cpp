#include "src/tools/text_output.hpp"

#include <ostream>
#include <stdexcept>

namespace fiber {

void TextOutput::flush() {
  stream_ << text_;
  text_.clear();
  if (!stream_) {
    throw std::runtime_error("the output cannot be written");
  }
}

}  // namespace fiber

#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "fiber_proximity/text/quote.hpp"

/// libFuzzer calls this with each input; whatever is thrown out of it is a finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace fiber::test {

inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// A finding that is no crash.
[[noreturn]] inline void finding(const std::string& what) {
  std::fprintf(stderr, "finding: %s\n", what.c_str());
  std::abort();
}

/// What an error says is one line that a terminal can show, however long and odd the input was.
inline void check_error(const std::exception& error) {
  constexpr std::size_t longest = 2000;
  const std::string line = error.what();
  if (line.empty() || line.size() > longest || fiber::shortened(line, line.size()) != line) {
    finding("an error that is empty, too long or not printable: " +
            fiber::shortened(line, longest));
  }
}

}  // namespace fiber::test

#pragma once

#include <sanitizer/allocator_interface.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <string>

#include "src/text/quote.hpp"

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

/// What may be in use for an input [byte]: a multiple of its size, and what little takes in any
/// case.
inline std::size_t times(std::size_t multiple, std::size_t size) {
  constexpr std::size_t in_any_case = std::size_t{4} << 20U;
  return in_any_case + multiple * size;
}

/// As long as it lives, no more memory is in use than it says, and no more time passes: that of the
/// processor, which does not depend on what else runs.
class Bounds {
 public:
  explicit Bounds(std::size_t most_bytes, double seconds = 1.0)
      : begin_(processor_time()), seconds_(seconds) {
    static const int installed = __sanitizer_install_malloc_and_free_hooks(allocated, freed);
    if (installed == 0) {
      finding("no room for another hook of malloc");
    }
    in_use() = 0;
    most() = static_cast<std::int64_t>(most_bytes);
  }
  ~Bounds() {
    lift();
    const double seconds = processor_time() - begin_;
    if (seconds > seconds_) {
      finding("an input that takes " + std::to_string(seconds) + " s");
    }
  }
  Bounds(const Bounds&) = delete;
  Bounds& operator=(const Bounds&) = delete;

  static void lift() { most() = unlimited; }

 private:
  static constexpr std::int64_t unlimited = INT64_MAX;

  static std::atomic<std::int64_t>& in_use() {
    static std::atomic<std::int64_t> bytes{0};
    return bytes;
  }
  static std::atomic<std::int64_t>& most() {
    static std::atomic<std::int64_t> bytes{unlimited};
    return bytes;
  }

  static void allocated(const volatile void* /*place*/, std::size_t size) {
    const std::int64_t bytes = in_use() += static_cast<std::int64_t>(size);
    if (bytes > most()) {
      const std::int64_t limit = most().exchange(unlimited);
      finding("an input for which " + std::to_string(bytes) + " bytes are in use, at most " +
              std::to_string(limit) + " may be");
    }
  }
  static void freed(const volatile void* place) {
    in_use() -=
        static_cast<std::int64_t>(__sanitizer_get_allocated_size(const_cast<const void*>(place)));
  }

  static double processor_time() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  double begin_;
  double seconds_;
};

}  // namespace fiber::test

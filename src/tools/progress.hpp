#pragma once

#include <unistd.h>

#include <iostream>
#include <string>

namespace fiber {

/// A line on stderr that tells how far a long run is; nothing unless stderr is a terminal.
class Progress {
 public:
  Progress() = default;
  explicit Progress(bool is_on) : on_(is_on) {}
  ~Progress() { show(""); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(const std::string& text) {
    if (on_) {
      std::cerr << clear_line << text << std::flush;
    }
  }

 private:
  static constexpr const char* clear_line = "\r\x1b[K";

  const bool on_ = isatty(STDERR_FILENO) == 1;
};

}  // namespace fiber

#include "src/tools/progress.hpp"

#include <unistd.h>

#include <iostream>

namespace fiber {
namespace {

constexpr const char* clear_line = "\r\x1b[K";

}  // namespace

Progress::Progress() : on_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() { show(""); }

void Progress::show(const std::string& text) {
  if (on_) {
    std::cerr << clear_line << text << std::flush;
  }
}

}  // namespace fiber

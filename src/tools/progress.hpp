#pragma once

#include <cstdint>
#include <string>

namespace fiber {

/// A line on stderr that tells how far a long run is; nothing unless stderr is a terminal.
class Progress {
 public:
  Progress();
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(const std::string& text);

 private:
  const bool on_;
};

}  // namespace fiber

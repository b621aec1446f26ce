// Loaded before the C library: whoever would give a file the name that FAULT is the end of waits
// there until it is killed.
#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

extern "C" int rename(const char* from, const char* to) noexcept {
  const char* const held = std::getenv("FAULT");
  const std::string end = held == nullptr ? "" : held;
  const std::string name = to;
  while (!end.empty() && name.size() >= end.size() &&
         name.compare(name.size() - end.size(), end.size(), end) == 0) {
    pause();
  }
  return reinterpret_cast<decltype(&rename)>(dlsym(RTLD_NEXT, "rename"))(from, to);
}

#pragma once

#include <cstdlib>
#include <filesystem>

namespace fiber::test {

/// Where the recorded cables and public edge pairs are, if they are anywhere.
inline std::filesystem::path shared_data() {
  const char* shared = std::getenv("FIBER_PROXIMITY_SHARED");
  return std::filesystem::path(shared != nullptr ? shared
                                                 : FIBER_PROXIMITY_SOURCE_DIR "/../shared") /
         "data";
}

}  // namespace fiber::test

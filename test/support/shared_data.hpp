#pragma once

#include <cstdlib>
#include <filesystem>

#include "test/support/source_folder.hpp"

namespace fiber::test {

/// Where the recorded cables and public edge pairs are, if they are anywhere.
inline std::filesystem::path shared_data() {
  const char* shared = std::getenv("FIBER_PROXIMITY_SHARED");
  return (shared != nullptr ? std::filesystem::path(shared) : source_folder() / "../shared") /
         "data";
}

}  // namespace fiber::test

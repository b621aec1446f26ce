#pragma once

#include <cstdint>
#include <cstring>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber::test {

/// FNV-1a over the bits of the coordinates.
inline std::uint64_t hash(const FiberAssembly& fibers) {
  std::uint64_t result = 0xcbf2'9ce4'8422'2325U;
  for (const Eigen::Vector3d& point : fibers.points()) {
    for (const double coordinate : point) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &coordinate, sizeof(bits));
      for (int byte = 0; byte < 8; ++byte) {
        result = (result ^ ((bits >> (8 * byte)) & 0xffU)) * 0x100'0000'01b3U;
      }
    }
  }
  return result;
}

}  // namespace fiber::test

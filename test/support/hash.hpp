#pragma once

#include <cstdint>
#include <cstring>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber::test {

/// FNV-1a over the bits of numbers.
class Hash {
 public:
  void add(double number) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &number, sizeof(bits));
    for (int byte = 0; byte < 8; ++byte) {
      value_ = (value_ ^ ((bits >> (8 * byte)) & 0xffU)) * 0x100'0000'01b3U;
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf2'9ce4'8422'2325U;
};

/// Of the coordinates.
inline std::uint64_t hash(const FiberAssembly& fibers) {
  Hash result;
  for (const Eigen::Vector3d& point : fibers.points()) {
    for (const double coordinate : {point.x(), point.y(), point.z()}) {
      result.add(coordinate);
    }
  }
  return result.value();
}

}  // namespace fiber::test

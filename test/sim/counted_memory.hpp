#pragma once

#include <cstddef>
#include <ostream>

namespace fiber::test {

/// Requests to operator new.
struct Memory {
  std::size_t allocations = 0;
  std::size_t bytes = 0;

  bool operator==(const Memory& other) const {
    return allocations == other.allocations && bytes == other.bytes;
  }
};

inline std::ostream& operator<<(std::ostream& out, const Memory& memory) {
  return out << memory.allocations << " allocations of " << memory.bytes << " bytes";
}

/// All that this process has made so far.
Memory counted_memory();

template <class Call>
Memory memory_of(const Call& call) {
  const Memory before = counted_memory();
  call();
  const Memory after = counted_memory();
  return {after.allocations - before.allocations, after.bytes - before.bytes};
}

}  // namespace fiber::test

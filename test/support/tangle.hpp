#pragma once

#include "test/support/assemblies.hpp"

namespace fiber::test {

/// Where nearly all is near all.
inline FiberAssembly tangle(Random& random, int fibers) {
  return walks(random, fibers, 12, 0.05, 0.1);
}

}  // namespace fiber::test

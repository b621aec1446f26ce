#pragma once

#include "test/support/assemblies.hpp"

namespace fiber::test {

/// Where nearly all is near all.
inline FiberAssembly tangle(Random& random, int fibers) {
  AssemblyBuilder builder;
  for (int fiber = 0; fiber < fibers; ++fiber) {
    builder.add_fiber(random_walk(random, 12, 0.05));
  }
  return builder.build({0.1});
}

}  // namespace fiber::test

// One engine in place of all: scenes of the fuzzer are small, and the others take long to compile.
#include "src/query/brute_force.hpp"

namespace fiber {

std::unique_ptr<ProximityEngine> make_engine(const std::string& /*name*/,
                                             const EngineOptions& /*options*/) {
  return std::make_unique<BruteForceEngine>();
}

}  // namespace fiber

#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "fiber_proximity/query/engine.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/cuda_tree.hpp"
#include "test/support/engine_names.hpp"
#include "test/support/random.hpp"

namespace fiber::test {

/// Tests that hold for the engine of any name.
class EnginesTest : public testing::TestWithParam<std::string> {
 protected:
  /// Calls with random members of all families that this engine can take.
  template <class Call>
  void for_each_assembly(int rounds, const Call& call) const {
    SCOPED_TRACE(seed_message());
    Random random;
    for (const AssemblyFamily& family : sampled(assembly_families(), random)) {
      for (int round = 0; round < rounds; ++round) {
        SCOPED_TRACE(family.name + ", round " + std::to_string(round));
        FiberAssembly fibers = family.make(random);
        fibers = GetParam() == "AL-threaded" ? equal_fibers(fibers) : fibers;
        call(fibers, random);
        if (testing::Test::HasFatalFailure()) {
          return;
        }
      }
    }
  }

  QueryResult ask(const FiberAssembly& fibers, const QueryOptions& options) const {
    const std::unique_ptr<ProximityEngine> engine = make_engine(GetParam());
    QueryResult result;
    engine->update(fibers);
    engine->query(options, result);
    return result;
  }
};

/// Parameters of tests of all engines, and their names.
inline auto all_engines() { return testing::ValuesIn(with_cuda_tree(all_engine_names())); }
/// Those of tests about kernels, bounds, limits and loops, which no volume has a part in.
inline auto engines_of_each_kind() {
  return testing::ValuesIn(with_cuda_tree(engine_names_of_each_kind()));
}
inline std::string name_of_engine(const testing::TestParamInfo<std::string>& engine) {
  return test_name(engine.param);
}

}  // namespace fiber::test

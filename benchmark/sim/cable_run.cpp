#include "benchmark/sim/cable_run.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <stdexcept>

#include "benchmark/kernels/child_process.hpp"
#include "benchmark/processor_time.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// The data that the child hands to its parent.
struct Told {
  CableEnding ending;
  double ms;
  std::array<char, 200> reason;  // ends with a zero
};
static_assert(static_cast<int>(CableEnding::ENDED) == 0, "what shared memory has at first");

bool are_finite(const std::vector<Vector3d>& nodes) {
  return std::all_of(nodes.begin(), nodes.end(),
                     [](const Vector3d& node) { return node.allFinite(); });
}

/// @param positions room for those of all steps
void simulate(const CableScene& scene, const CableMethod& method, Vector3d* positions, Told& told) {
  const auto simulation = method.make(scene);
  for (int i = 0; i <= scene.steps(); ++i) {
    if (i > 0) {
      told.ms += processor_time_of([&] { simulation->step(); });
    }
    const std::vector<Vector3d> nodes = simulation->positions();
    assert(nodes.size() == scene.cables.size() * (method.segments + 1));
    if (!are_finite(nodes)) {
      throw std::runtime_error("positions are not finite");
    }
    positions = std::copy(nodes.begin(), nodes.end(), positions);
  }
  told.ending = CableEnding::DONE;
}

}  // namespace

CableRun run_cables(const CableScene& scene, const CableMethod& method) {
  const std::size_t nodes = scene.cables.size() * (method.segments + 1);
  const std::size_t states = static_cast<std::size_t>(scene.steps()) + 1;
  const SharedArray<Told> told(1);
  const SharedMemory positions(states * nodes * sizeof(Vector3d));
  auto* const begin = static_cast<Vector3d*>(positions.begin());
  survives([&] {
    try {
      simulate(scene, method, begin, told[0]);
    } catch (const std::exception& error) {
      told[0].ending = CableEnding::DIVERGED;
      std::strncpy(told[0].reason.data(), error.what(), told[0].reason.size() - 1);
    }
  });
  CableRun run{told[0].ending, told[0].reason.data(), told[0].ms, {}};
  if (run.ending == CableEnding::DONE) {
    for (std::size_t i = 0; i < states; ++i) {
      run.positions.emplace_back(begin + i * nodes, begin + (i + 1) * nodes);
    }
  }
  return run;
}

}  // namespace fiber

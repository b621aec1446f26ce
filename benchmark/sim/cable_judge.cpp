#include "benchmark/sim/cable_judge.hpp"

#include <algorithm>
#include <cassert>
#include <set>
#include <utility>

#include "fiber_proximity/query/engine.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

FiberAssembly assembly_of(const CableScene& scene, const std::vector<Vector3d>& nodes,
                          double radius) {
  const std::size_t cables = scene.cables.size();
  std::vector<std::uint32_t> offsets;
  for (std::size_t cable = 0; cable <= cables; ++cable) {
    offsets.push_back(static_cast<std::uint32_t>(cable * nodes.size() / cables));
  }
  return {nodes, offsets, {radius}};
}

/// How deep surfaces are in each other and in the floor [m].
double depth_of(const CableScene& scene, const std::vector<Vector3d>& nodes,
                ProximityEngine& engine) {
  double depth = 0.0;
  for (const Vector3d& node : nodes) {
    depth = std::max(depth, scene.radius - node.z());
  }
  const FiberAssembly fibers = assembly_of(scene, nodes, scene.radius);
  engine.update(fibers);
  QueryOptions options;
  options.type = QueryType::CLOSEST;
  options.pairing = Pairing::DIFFERENT_FIBERS;
  QueryResult result;
  engine.query(options, result);
  return result.contacts.empty() ? depth : std::max(depth, -result.contacts.front().distance);
}

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

/// Cables whose axes meet between two states.
void add_passed(const CableScene& scene, const std::vector<Vector3d>& before,
                const std::vector<Vector3d>& after, ProximityEngine& engine, Pairs& passed) {
  const double thin = 1e-3 * scene.radius;
  const FiberAssembly fibers_before = assembly_of(scene, before, thin);
  const FiberAssembly fibers_after = assembly_of(scene, after, thin);
  engine.update_motion(fibers_before, fibers_after);
  MotionOptions options;
  options.pairing = Pairing::DIFFERENT_FIBERS;
  options.tolerance = thin;
  MotionResult result;
  engine.query_motion(options, result);
  for (const auto& contacts : {result.contacts, result.touching}) {
    for (const MotionContact& contact : contacts) {
      passed.emplace(contact.fiber_a, contact.fiber_b);
    }
  }
}

}  // namespace

CableVerdict judge_cables(const CableScene& scene, const CableRun& run) {
  assert(run.ending == CableEnding::DONE);
  CableVerdict verdict;
  const std::vector<Vector3d>& first = run.positions.front();
  const std::vector<Vector3d>& last = run.positions.back();
  for (const std::vector<Vector3d>& nodes : run.positions) {
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      verdict.moved = std::max(verdict.moved, (nodes[i] - first[i]).norm());
    }
  }
  for (std::size_t i = 0; i < last.size(); ++i) {
    const Vector3d way = last[i] - run.positions[run.positions.size() - 2][i];
    verdict.speed = std::max(verdict.speed, way.norm() / CableScene::step);
  }
  if (!scene.touches) {
    return verdict;
  }
  const auto engine = make_engine("run_tree", {1});
  const auto rest = static_cast<std::size_t>(0.25 / CableScene::step);
  const std::size_t nodes_per_cable = first.size() / scene.cables.size();
  Pairs passed;
  std::set<std::size_t> below;
  for (std::size_t i = 0; i < run.positions.size(); ++i) {
    const std::vector<Vector3d>& nodes = run.positions[i];
    const double depth = depth_of(scene, nodes, *engine) / scene.radius;
    verdict.deepest = std::max(verdict.deepest, depth);
    if (i + rest >= run.positions.size()) {
      verdict.depth = std::max(verdict.depth, depth);
    }
    if (i > 0) {
      add_passed(scene, run.positions[i - 1], nodes, *engine, passed);
    }
  }
  for (std::size_t node = 0; node < last.size(); ++node) {
    if (last[node].z() < 0.0) {
      below.insert(node / nodes_per_cable);
    }
  }
  verdict.passed = static_cast<int>(passed.size() + below.size());
  return verdict;
}

}  // namespace fiber

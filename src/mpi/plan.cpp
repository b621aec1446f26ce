#include "src/mpi/plan.hpp"

#include <algorithm>
#include <cmath>

#include "src/mpi/fiber_runs.hpp"

namespace fiber {
namespace {

// At worst, others bring all that a part owns: pieces of sixteen segments, with a node more.
constexpr double nodes_per_own_segment = 1.0 + 1.0 / 16.0;

struct MeanLoad {
  double segments = 0.0;
  double share = 0.0;  // of halos
};

MeanLoad mean_of(const std::vector<PartLoad>& loads) {
  double segments = 0.0;
  double halo = 0.0;
  for (const PartLoad& load : loads) {
    segments += static_cast<double>(load.segments);
    halo += static_cast<double>(load.halo_segments);
  }
  return {segments / static_cast<double>(loads.size()), segments > 0.0 ? halo / segments : 0.0};
}

double mean_segments(const std::vector<PlannedPart>& parts) {
  double sum = 0.0;
  for (const PlannedPart& part : parts) {
    sum += part.segments;
  }
  return sum / static_cast<double>(parts.size());
}

}  // namespace

std::vector<PlannedPart> plan_of(const std::vector<PartLoad>& loads) {
  std::vector<PlannedPart> parts;
  parts.reserve(loads.size());
  for (const PartLoad& load : loads) {
    PlannedPart& part = parts.emplace_back();
    part.segments = static_cast<double>(load.segments);
    part.halo_segments = static_cast<double>(load.halo_segments);
    part.halo_bytes =
        static_cast<double>(sizeof(FiberNode) * (load.halo_segments + load.halo_runs) +
                            sizeof(FiberRun) * load.halo_runs);
    part.neighbours = static_cast<double>(load.neighbours);
  }
  return parts;
}

HaloLaw::HaloLaw(const std::vector<PartLoad>& large, const std::vector<PartLoad>& small,
                 int dimensions)
    : dimensions_(dimensions) {
  const MeanLoad far = mean_of(large);
  const MeanLoad near = mean_of(small);
  const double x = x_of(far.segments);
  const double y = x_of(near.segments);
  quadratic_ = (near.share / y - far.share / x) / (y - x);
  linear_ = far.share / x - quadratic_ * x;
}

double HaloLaw::x_of(double segments) const { return std::pow(segments, -1.0 / dimensions_); }

double HaloLaw::share(double segments) const {
  const double x = x_of(segments);
  return std::max(0.0, linear_ * x + quadratic_ * x * x);
}

ScenePlan sample_scene(const Communicator& ranks, const SampleScene& scene, std::uint64_t segments,
                       int parts, double margin, int dimensions) {
  constexpr int few_parts = 16;
  constexpr std::uint64_t most_scenes = 4;
  constexpr std::uint64_t times_smaller = 8;
  const auto scenes = std::clamp<std::uint64_t>(few_parts / parts, 1, most_scenes);
  std::uint64_t number = 0;
  const auto count = [&](std::uint64_t many, std::uint64_t size) {
    std::vector<PartLoad> loads;
    for (const std::uint64_t end = number + many; number < end; ++number) {
      const std::vector<PartLoad> some = part_loads(ranks, scene(size, number), parts, margin);
      loads.insert(loads.end(), some.begin(), some.end());
    }
    return loads;
  };
  const std::vector<PartLoad> large = count(scenes, segments);
  const std::vector<PartLoad> small = count(most_scenes * scenes, segments / times_smaller);
  return {plan_of(large), HaloLaw(large, small, dimensions)};
}

std::vector<PlannedPart> grown(std::vector<PlannedPart> parts, const HaloLaw& law,
                               double segments) {
  const double before = mean_segments(parts);
  // Some parts have more neighbours than others, and keep them.
  const double share_before = law.share(before);
  const double change = share_before > 0.0 ? law.share(segments) / share_before : 0.0;
  for (PlannedPart& part : parts) {
    const double factor = change * segments / before;
    part.segments += segments - before;  // the split is off by a few pieces, of any size
    part.halo_segments *= factor;
    part.halo_bytes *= factor;
  }
  return parts;
}

void predict_steps(std::vector<PlannedPart>& parts, const StepCosts& costs,
                   const Network& network) {
  const double alone = costs.alone * mean_segments(parts);
  for (PlannedPart& part : parts) {
    const double own_nodes = network.is_adopted ? 0.0 : nodes_per_own_segment * part.segments;
    part.bytes = sizeof(FiberNode) * own_nodes + part.halo_bytes;
    part.seconds = costs.together * (part.segments + part.halo_segments) +
                   part.bytes / network.bandwidth + part.neighbours * network.latency;
    part.efficiency = part.seconds > 0.0 ? alone / part.seconds : 1.0;
  }
}

}  // namespace fiber

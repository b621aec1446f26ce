#include "src/mpi/part_topology.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/geometry/fiber_graph.hpp"

namespace fiber {
namespace {

void require_length(const char* name, std::size_t length, std::size_t count, const char* item) {
  if (length != 0 && length != count) {
    throw std::invalid_argument("the topology's " + std::string(name) + " has " +
                                std::to_string(length) + " value(s) for " + std::to_string(count) +
                                ' ' + item + "(s); give none or one per " + item);
  }
}

}  // namespace

FiberTopology part_topology(const FiberAssembly& parts, const FiberTopology& given) {
  require_length("closed", given.closed.size(), parts.fiber_count(), "part");
  require_length("joints", given.joints.size(), parts.point_count(), "point");
  FiberGraph::require_tolerance(given.joint_tolerance);
  if (parts.graph() == nullptr) {
    return joins_anything(given) ? given : FiberTopology();
  }
  if (joins_anything(given)) {
    throw std::invalid_argument(
        "the parts are closed or joined themselves, and a topology is given beside them: give one "
        "of both");
  }
  FiberTopology topology = parts.topology();
  if (!topology.joints.empty()) {
    parts.graph()->repeat_first_points(topology.joints);
  }
  return topology;
}

std::optional<double> common_tolerance(const Communicator& ranks, const FiberTopology& topology) {
  struct Tolerance {
    bool counts = false;
    double value = -1.0;  // [m]; -1: none is set
  };
  const std::vector<Tolerance> of_ranks = ranks.gather_all(
      Tolerance{joins_anything(topology), topology.joint_tolerance.value_or(-1.0)});
  const auto counts = [](const Tolerance& tolerance) { return tolerance.counts; };
  const auto first = std::find_if(of_ranks.begin(), of_ranks.end(), counts);
  for (auto other = first; other != of_ranks.end(); ++other) {
    if (other->counts && other->value != first->value) {
      throw std::invalid_argument("joint_tolerance is not the same on all ranks, it must be");
    }
  }
  return first == of_ranks.end() || first->value < 0.0 ? std::nullopt : std::optional(first->value);
}

}  // namespace fiber

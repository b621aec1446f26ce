#include "src/mpi/part_topology.hpp"

#include <cstddef>
#include <stdexcept>
#include <string>

#include "src/geometry/fiber_graph.hpp"
#include "src/io/number.hpp"

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
  if (!(given.joint_tolerance.value_or(0.0) >= 0.0)) {
    throw std::invalid_argument("joint_tolerance is " + text_of(*given.joint_tolerance) +
                                " m, it must be at least 0");
  }
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

}  // namespace fiber

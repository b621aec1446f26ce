#include "fiber_proximity/query/nearest_segments.hpp"

#include <limits>
#include <sstream>
#include <stdexcept>

namespace fiber {
namespace {

void check(const Eigen::Vector3d& point, std::uint32_t k) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!FiberAssembly::is_valid_coordinate(point[axis])) {
      std::ostringstream message;
      message << "point: "
              << "xyz"[axis] << " is " << point[axis] << ", " << FiberAssembly::coordinate_rule;
      throw std::invalid_argument(message.str());
    }
  }
  if (k == 0) {
    throw std::invalid_argument("k is 0, it must be at least 1");
  }
}

}  // namespace

void nearest_segments(const ProximityEngine& engine, const Eigen::Vector3d& point, std::uint32_t k,
                      QueryResult& result) {
  check(point, k);
  QueryOptions options;
  options.type = QueryType::LIMITED;
  options.max_contacts = k;
  options.margin = std::numeric_limits<double>::infinity();
  // A point is a capsule of no length and no radius.
  engine.query_shape(FiberAssembly({point, point}, {0, 2}, {0.0}), options, result);
  sort_by_distance(result.contacts);
}

}  // namespace fiber

#include "kdop_engines.hpp"

#include <array>
#include <cassert>
#include <utility>

#include "fiber_proximity/bounds/kdop.hpp"
#include "fiber_proximity/hierarchy/spatial_hierarchy.hpp"
#include "fiber_proximity/query/hierarchy_engine.hpp"

namespace fiber {
namespace {

/// 100 directions, four to a group.
constexpr std::size_t most_groups = 25;

using Maker = std::unique_ptr<ProximityEngine> (*)(const std::vector<Eigen::Vector3d>& directions);

template <template <class> class Kind, int Groups>
std::unique_ptr<ProximityEngine> make(const std::vector<Eigen::Vector3d>& directions) {
  using Hierarchy = Kind<Kdop<Groups>>;
  return std::make_unique<HierarchyEngine<Hierarchy>>(
      Hierarchy(KdopDirections<Groups>(directions)));
}

/// Makers by number of groups, from one.
template <template <class> class Kind, std::size_t... Index>
constexpr std::array<Maker, most_groups> makers(std::index_sequence<Index...> /*indices*/) {
  return {make<Kind, static_cast<int>(Index) + 1>...};
}

template <template <class> class Kind>
std::unique_ptr<ProximityEngine> make_engine_for(const std::vector<Eigen::Vector3d>& directions) {
  static constexpr std::array<Maker, most_groups> by_groups =
      makers<Kind>(std::make_index_sequence<most_groups>());
  const std::size_t groups = (directions.size() + slabs_per_group - 1) / slabs_per_group;
  assert(groups >= 1 && groups <= most_groups);
  return by_groups[groups - 1](directions);
}

}  // namespace

std::unique_ptr<ProximityEngine> make_layered_kdop_engine(
    const std::vector<Eigen::Vector3d>& directions) {
  return make_engine_for<LayeredHierarchy>(directions);
}

std::unique_ptr<ProximityEngine> make_spatial_kdop_engine(
    const std::vector<Eigen::Vector3d>& directions) {
  return make_engine_for<SpatialHierarchy>(directions);
}

}  // namespace fiber

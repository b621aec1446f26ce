#include <cassert>
#include <utility>

#include "src/paper/bounds/kdop.hpp"
#include "src/paper/engines/hierarchy_engine.hpp"

namespace fiber {
namespace {

/// Groups of four directions that volumes are made for, up to 100 directions. Numbers between two
/// of them take the larger one, whose last slabs are copies: each of these takes the compiler two
/// seconds, and a tenth more slabs cost a query less than a tenth.
using GroupCounts = std::integer_sequence<int, 1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 19, 22, 25>;

using KdopMaker =
    std::unique_ptr<ProximityEngine> (*)(const std::vector<Eigen::Vector3d>& directions);

template <template <class> class Kind, int Groups>
std::unique_ptr<ProximityEngine> make_kdop(const std::vector<Eigen::Vector3d>& directions) {
  using Hierarchy = Kind<Kdop<Groups>>;
  return std::make_unique<HierarchyEngine<Hierarchy>>(
      Hierarchy(KdopDirections<Groups>(directions)));
}

/// The maker of the smallest volume that has room for the directions.
template <template <class> class Kind, int... Groups>
KdopMaker maker_for(std::size_t directions, std::integer_sequence<int, Groups...> /*counts*/) {
  KdopMaker maker = nullptr;
  const auto consider = [&](int groups, KdopMaker candidate) {
    if (maker == nullptr && directions <= static_cast<std::size_t>(groups) * slabs_per_group) {
      maker = candidate;
    }
  };
  (consider(Groups, make_kdop<Kind, Groups>), ...);
  assert(maker != nullptr);
  return maker;
}

template <template <class> class Kind>
std::unique_ptr<ProximityEngine> make_engine_for(const std::vector<Eigen::Vector3d>& directions) {
  return maker_for<Kind>(directions.size(), GroupCounts())(directions);
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

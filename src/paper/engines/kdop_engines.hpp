#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "fiber_proximity/query/engine.hpp"

namespace fiber {

/// DL: the layered hierarchy of k-DOPs with these k/2 unit directions, 3 to 100 of them.
std::unique_ptr<ProximityEngine> make_layered_kdop_engine(
    const std::vector<Eigen::Vector3d>& directions);

/// DS: the spatially adapted one.
std::unique_ptr<ProximityEngine> make_spatial_kdop_engine(
    const std::vector<Eigen::Vector3d>& directions);

}  // namespace fiber

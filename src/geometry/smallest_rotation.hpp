#pragma once

#include <Eigen/Geometry>

#include "fiber_proximity/export.hpp"

namespace fiber {

/// The rotation by the smallest angle that turns one direction into another. Of opposite directions
/// it turns about any axis at right angles to them. Eigen's Quaternion::FromTwoVectors does the
/// same, but compiles a singular value decomposition in every source that calls it.
/// @param from, to of any length but zero up to 1e150
FIBER_PROXIMITY_EXPORT Eigen::Quaterniond smallest_rotation(const Eigen::Vector3d& from,
                                                            const Eigen::Vector3d& to);

}  // namespace fiber

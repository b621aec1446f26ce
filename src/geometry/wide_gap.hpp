#pragma once

#include <Eigen/Core>
#include <optional>

#include "fiber_proximity/geometry/exact_distance.hpp"

namespace fiber {

/// gap_at_most() in numbers of twice the digits: whether there are two points that are surely no
/// further apart than the limit, or a plane that surely keeps the segments further apart. Nothing
/// where these do not tell, as of distances that are within a part of about 2⁻⁹⁴ of the limit.
/// @param robust tells where the nearest points are; what is proven does not depend on it
std::optional<bool> wide_gap_at_most(const SegmentDistance& robust, const Eigen::Vector3d& p0,
                                     const Eigen::Vector3d& p1, const Eigen::Vector3d& q0,
                                     const Eigen::Vector3d& q1, const ContactLimit& limit);

}  // namespace fiber

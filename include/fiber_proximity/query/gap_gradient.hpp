#pragma once

#include <Eigen/Core>

#include "fiber_proximity/query/contact.hpp"

namespace fiber {

/// How the gap of two segments changes as their end points move [m per m].
struct GapGradient {
  Eigen::Vector3d a0;  ///< start of a
  Eigen::Vector3d a1;  ///< end of a
  Eigen::Vector3d b0;
  Eigen::Vector3d b1;
};

/// Derivatives of Contact::distance by the end points of the axes: −(1−s)·n, −s·n, (1−t)·n and t·n
/// with the normal n from a to b. The nearest points need not be followed as they move: at a
/// minimum the distance does not change with them.
///
/// Where segments are parallel side by side, more than one pair of points is nearest, and this is
/// the derivative of one of these; the gap has a kink there. Where the axes meet, it has one, too,
/// and the normal is any at right angles to both.
inline GapGradient gradient_of(const Contact& contact) {
  const Eigen::Vector3d& n = contact.normal;
  return {(contact.s - 1.0) * n, -contact.s * n, (1.0 - contact.t) * n, contact.t * n};
}

}  // namespace fiber

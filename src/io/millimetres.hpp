#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>

#include "src/io/bytes.hpp"
#include "src/io/one_frame.hpp"

namespace fiber {

// Tractograms are in millimetres and single precision, assemblies in metres and double.

inline Eigen::Vector3d metres_of(const Eigen::Vector3d& millimetres) {
  return millimetres / 1000.0;
}

/// Appends a point [mm].
/// @throws std::invalid_argument if it is beyond single precision
inline void append_millimetres(std::string& bytes, const char* end, const FiberAssembly& fibers,
                               std::size_t fiber, std::size_t point) {
  for (int axis = 0; axis < 3; ++axis) {
    const char name[] = {"xyz"[axis], '\0'};
    append_value(bytes, single_precision(end, 1000.0 * fibers.points()[point][axis], name, fiber,
                                         point - fibers.offsets()[fiber]));
  }
}

}  // namespace fiber

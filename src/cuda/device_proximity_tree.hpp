#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fiber_proximity/cuda/device_proximity.hpp"
#include "src/cuda/device.hpp"

namespace fiber {

/// The state of a DeviceProximity but the coordinates.
struct DeviceProximity::Tree {
  std::unique_ptr<DeviceTree> tree;
  std::vector<double> radii;                    // by first point [m]
  std::vector<double> given_radii;              // [m]
  RadiusPer radius_per = RadiusPer::ASSEMBLY;   // of these
  std::vector<std::uint32_t> candidates;        // as they were given; none without
  std::vector<std::uint32_t> candidate_points;  // where those of each begin, and of the last end
  HostFibers fibers;                            // without coordinates
  bool has_points = false;
};

}  // namespace fiber

#pragma once

#include <string>

namespace fiber_proximity_ros {

/// Whether a frame is a camera's optical one (REP 103: x to the right, y down, z forwards), which
/// its name says.
inline bool is_optical_frame(const std::string& frame) {
  return frame.find("optical") != std::string::npos;
}

}  // namespace fiber_proximity_ros

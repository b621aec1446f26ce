#pragma once

#include <cstdint>
#include <string>

#include "fiber_proximity/io/file.hpp"
#include "fiber_proximity/sim/forces.hpp"
#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

/// Writes what acts in rods and on them frame by frame, as CSV with the columns
/// frame,kind,fiber,index,fx,fy,fz,mx,my,mz [N, N m]. By kind:
///
/// - tension: of edge `index`; what the part of the rod after it exerts on the edge
/// - twisting: of edge `index`; the moment of the part after it
/// - bending: of node `index`; the moment of the part after it
/// - normal, friction: of a contact, on edge `index`; those of two rods have a row for each of them
/// - joint: what a joint exerts on node `index`, one of those that it joins
/// - hold: what a hold exerts on node `index`
/// - load: the share of a load at node `index`, its moment on the edge after it
///
/// All numbers read back as the same.
class ForceWriter {
 public:
  /// @throws FileError
  explicit ForceWriter(const std::string& path);

  /// @param rods where the forces act
  /// @throws FileError
  void write(std::int64_t frame, const Rods& rods, const RodForces& forces);

  /// Call once, after the last frame: only then is all of it in the file.
  /// @throws FileError
  void finish();

 private:
  OutputFile file_;
};

}  // namespace fiber

#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "validation/geometry/hard_motions.hpp"

namespace fiber {

/// A way to find when two moving capsules first touch, ours or another library's.
class MotionKernel {
 public:
  MotionKernel() = default;
  MotionKernel(const MotionKernel&) = delete;
  MotionKernel& operator=(const MotionKernel&) = delete;
  virtual ~MotionKernel() = default;

  /// Whether it knows such motions.
  virtual bool can_answer(const HardMotion& /*motion*/) const { return true; }

  /// Whether its answers are within any tolerance that it is given.
  virtual bool keeps_tolerance() const { return false; }

  /// Makes of motions it can answer what it works on. This is not measured. They live until the
  /// next call.
  /// @param tolerance of gaps [m]
  virtual void prepare(const std::vector<HardMotion>& motions, double tolerance) = 0;

  /// The first contacts of `count` motions from the one with index `first` on. This is measured.
  /// One that states a single time has it as `upper`, and a `lower` before it by as much as the
  /// tolerance allows.
  /// @throws std::exception if it has no answer
  virtual void find(std::size_t first, std::size_t count, ContactTime* times) = 0;
};

/// The kernel of this name, by make_kernel().
std::unique_ptr<MotionKernel> make_motion_kernel(const std::string& name);

/// Names of the kernels in this build.
std::vector<std::string> motion_kernel_names();

}  // namespace fiber

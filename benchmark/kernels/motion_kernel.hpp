#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "benchmark/kernels/kernel.hpp"
#include "validation/geometry/hard_motions.hpp"

namespace fiber {

/// A way to find when two moving capsules first touch. One that states a single time has it as
/// `upper`, and a `lower` before it by as much as the tolerance allows. run() throws where there is
/// no answer.
class MotionKernel : public BenchmarkKernel<HardMotion, ContactTime> {
 public:
  /// Whether it knows such motions.
  virtual bool can_answer(const HardMotion& /*motion*/) const { return true; }

  /// Whether its answers are within any tolerance that it is given.
  virtual bool keeps_tolerance() const { return false; }

  /// Sets the tolerance of gaps [m]; it holds from the next prepare() on.
  void set_tolerance(double tolerance) { tolerance_ = tolerance; }

 protected:
  double tolerance() const { return tolerance_; }

 private:
  double tolerance_ = 0.0;  // [m]
};

/// The kernel of this name, by make_kernel().
std::unique_ptr<MotionKernel> make_motion_kernel(const std::string& name);

/// Names of the kernels in this build.
std::vector<std::string> motion_kernel_names();

}  // namespace fiber

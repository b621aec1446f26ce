#pragma once

#include <algorithm>
#include <vector>

#include "benchmark/kernels/motion_kernel.hpp"

namespace fiber {

/// Whether both capsules have thickness and keep length and direction: of all motions of ends on
/// straight lines these are those of rigid bodies.
inline bool is_translation(const HardMotion& motion) {
  const auto keeps_axis = [](const Eigen::Vector3d* before, const Eigen::Vector3d* after) {
    constexpr double rounding = 0x1p-50;
    const Eigen::Vector3d change = (after[1] - after[0]) - (before[1] - before[0]);
    const double size = std::max(before[0].cwiseAbs().maxCoeff(), after[0].cwiseAbs().maxCoeff()) +
                        std::max(before[1].cwiseAbs().maxCoeff(), after[1].cwiseAbs().maxCoeff());
    return change.cwiseAbs().maxCoeff() <= rounding * size;
  };
  return motion.radius_a > 0.0 && motion.radius_b > 0.0 &&
         keeps_axis(motion.a_before.data(), motion.a_after.data()) &&
         keeps_axis(motion.b_before.data(), motion.b_after.data());
}

/// The answer of a library that states one time: contact may have begun earlier by as much as these
/// capsules take for the tolerance [m].
inline ContactTime stated_time(const HardMotion& motion, double time, double tolerance) {
  const Eigen::Vector3d way =
      (motion.a_after[0] - motion.a_before[0]) - (motion.b_after[0] - motion.b_before[0]);
  const double length = way.stableNorm();
  const double earlier = length > 0.0 ? tolerance / length : 1.0;
  return {true, std::max(0.0, time - earlier), time, false};
}

/// A kernel that knows translations of capsules, as objects of a library that are made of both ends
/// before, both after, and a radius [m].
template <class Capsule>
class MovingCapsules : public MotionKernel {
 public:
  bool can_answer(const HardMotion& motion) const override { return is_translation(motion); }

  void prepare(const std::vector<HardMotion>& motions) override {
    motions_ = &motions;
    a_.clear();
    b_.clear();
    for (const HardMotion& motion : motions) {
      a_.emplace_back(motion.a_before.data(), motion.a_after.data(), motion.radius_a);
      b_.emplace_back(motion.b_before.data(), motion.b_after.data(), motion.radius_b);
    }
  }

 protected:
  const std::vector<HardMotion>* motions_ = nullptr;
  std::vector<Capsule> a_;
  std::vector<Capsule> b_;
};

}  // namespace fiber

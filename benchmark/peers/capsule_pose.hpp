#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "benchmark/kernels/pair_kernel.hpp"

namespace fiber {

/// A segment as libraries of collision detection want it: along an axis, rotated and moved.
struct CapsulePose {
  Eigen::Vector3d centre;  ///< [m]
  Eigen::Vector3d along;   ///< unit vector; any for a segment of no length
  Eigen::Vector3d side;    ///< unit vectors perpendicular to it,
  Eigen::Vector3d other;   ///< right-handed: along = side × other
  double length = 0.0;     ///< [m]
};

inline CapsulePose capsule_pose(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1) {
  const Eigen::Vector3d axis = p1 - p0;
  CapsulePose pose;
  pose.centre = 0.5 * (p0 + p1);
  pose.length = axis.stableNorm();
  // Twice: the length of a tiny axis has few digits.
  pose.along = pose.length > 0.0 ? axis.stableNormalized().normalized() : Eigen::Vector3d::UnitZ();
  pose.side = pose.along.unitOrthogonal();
  pose.other = pose.along.cross(pose.side);
  return pose;
}

/// A kernel that measures gaps of the capsules of pairs, as objects of a library that are made of
/// two points and a radius [m].
template <class Capsule>
class CapsulePairs : public PairKernel {
 public:
  void prepare(const std::vector<HardPair>& pairs) override {
    pairs_ = &pairs;
    a_.clear();
    b_.clear();
    for (const HardPair& pair : pairs) {
      a_.emplace_back(pair.p0, pair.p1, pair.radius_a);
      b_.emplace_back(pair.q0, pair.q1, pair.radius_b);
    }
  }

  PairAnswer answer(std::size_t index) override {
    const HardPair& pair = (*pairs_)[index];
    const double found = gap(index);
    if (std::isnan(found)) {
      throw std::runtime_error("no contact point");
    }
    PairAnswer answer;
    answer.distance = found + (pair.radius_a + pair.radius_b);
    answer.contact = found <= 0.0;
    return answer;
  }

 protected:
  /// The gap of the surfaces [m], nan without an answer.
  virtual double gap(std::size_t index) = 0;

  const std::vector<HardPair>* pairs_ = nullptr;
  std::vector<Capsule> a_;
  std::vector<Capsule> b_;
};

}  // namespace fiber

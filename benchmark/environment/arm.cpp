#include "benchmark/environment/arm.hpp"

#include "src/scenes/portable_math.hpp"

namespace fiber {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// How a link is attached to the one before it: the joint is at the end of that, turns about an
/// axis of its frame, and the link goes on along its own z axis.
struct Joint {
  bool bends;    // about the y axis; others turn about the z axis
  double rest;   // [turns]
  double swing;  // [turns]
  double phase;  // [turns]
};

constexpr std::array<Joint, arm_link_count> joints{{{false, 0.0, 0.0, 0.0},
                                                    {false, 0.0, 0.09, 0.0},
                                                    {true, 0.13, 0.01, 0.25},
                                                    {true, 0.09, 0.01, 0.40},
                                                    {true, 0.11, 0.01, 0.10},
                                                    {true, 0.13, 0.02, 0.30},
                                                    {false, 0.0, 0.10, 0.00},
                                                    {true, 0.04, 0.02, 0.00}}};

Matrix3d rotation(const Joint& joint, double periods) {
  const double turn = joint.rest + joint.swing * sine_of_turns(periods + joint.phase);
  const double c = cosine_of_turns(turn);
  const double s = sine_of_turns(turn);
  Matrix3d matrix;
  if (joint.bends) {
    matrix << c, 0.0, s, 0.0, 1.0, 0.0, -s, 0.0, c;
  } else {
    matrix << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  }
  return matrix;
}

}  // namespace

const std::array<ArmLink, arm_link_count>& arm_links() {
  static const std::array<ArmLink, arm_link_count> links{{{"base", 0.080, 0.10},
                                                          {"shoulder", 0.075, 0.05},
                                                          {"upper_arm", 0.060, 0.42},
                                                          {"elbow", 0.065, 0.00},
                                                          {"forearm", 0.050, 0.39},
                                                          {"wrist", 0.045, 0.10},
                                                          {"flange", 0.050, 0.00},
                                                          {"gripper", 0.030, 0.15}}};
  return links;
}

std::array<Isometry3d, arm_link_count> arm_poses(double periods) {
  std::array<Isometry3d, arm_link_count> poses;
  Isometry3d joint = Isometry3d::Identity();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double length = arm_links()[i].length;
    joint.linear() = (joint.linear() * rotation(joints[i], periods)).eval();
    poses[i] = joint;
    poses[i].translation() += length / 2.0 * joint.linear().col(2);
    joint.translation() += length * joint.linear().col(2);
  }
  return poses;
}

}  // namespace fiber

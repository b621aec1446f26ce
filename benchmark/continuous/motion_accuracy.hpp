#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "validation/geometry/motion_score.hpp"

namespace fiber {

/// An answer that the truth contradicts.
struct WrongAnswer {
  HardMotion motion;
  double tolerance = 0.0;  ///< [m]
  ContactTime answer;
};

/// How right answers to motions are.
struct MotionAccuracy {
  MotionScore score;
  std::vector<WrongAnswer> wrong;  ///< the first few

  void add(const WrongAnswer& answer);
  MotionAccuracy& operator+=(const MotionAccuracy& more);
};

/// Who answers, contact_time() or what a test puts in its place.
using AnswerMotion =
    std::function<ContactTime(const SegmentMotions& motions, double tolerance_in_metres)>;

/// Which motions of a family are drawn.
struct MotionDraw {
  std::uint32_t count = 1;
  std::uint64_t seed = 1;
};

/// The accuracy of answers to motions of a family, for each tolerance, a part of the motion's
/// extent. The same on any number of threads; none of them stays.
/// @param tolerances parts
std::vector<MotionAccuracy> motion_accuracy(const MotionFamily& family, const MotionDraw& draw,
                                            const std::vector<double>& tolerances,
                                            std::uint32_t threads, const AnswerMotion& answer);

}  // namespace fiber

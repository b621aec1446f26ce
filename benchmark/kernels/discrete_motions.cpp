#include <algorithm>

#include "benchmark/kernels/makers.hpp"

namespace fiber {
namespace {

/// A check without regard to motion: distances at the beginning and at the end of each of some
/// steps of equal length, until there is a contact. All motions that are still free are asked about
/// together.
class DiscreteMotions final : public MotionKernel {
 public:
  explicit DiscreteMotions(int steps) : steps_(steps) {}

  void prepare(const std::vector<HardMotion>& motions) override {
    motions_ = &motions;
    points_.resize(4 * motions.size());
    a_.clear();
    b_.clear();
    for (std::size_t i = 0; i < motions.size(); ++i) {
      a_.push_back(&points_[4 * i]);
      b_.push_back(&points_[4 * i + 2]);
    }
    free_.resize(motions.size());
    distances_.resize(motions.size());
  }

  void run(std::size_t first, std::size_t count, ContactTime* times) override {
    std::fill_n(times, count, ContactTime());
    for (std::size_t i = 0; i < count; ++i) {
      free_[i] = i;
    }
    std::size_t left = count;
    for (int step = 0; step <= steps_ && left > 0; ++step) {
      left = look(first, left, step, times);
    }
  }

 private:
  /// How many of those that are free stay so.
  std::size_t look(std::size_t first, std::size_t left, int step, ContactTime* times) {
    const double time = static_cast<double>(step) / steps_;
    for (std::size_t i = 0; i < left; ++i) {
      place((*motions_)[first + free_[i]], time, &points_[4 * i]);
    }
    segment_distances(a_.data(), b_.data(), left, distances_.data());
    std::size_t still = 0;
    for (std::size_t i = 0; i < left; ++i) {
      const HardMotion& motion = (*motions_)[first + free_[i]];
      if (distances_[i].distance <= motion.radius_a + motion.radius_b) {
        times[free_[i]] = {true, std::max(0.0, (step - 1.0) / steps_), time, true};
      } else {
        free_[still++] = free_[i];
      }
    }
    return still;
  }

  static void place(const HardMotion& motion, double time, Eigen::Vector3d* points) {
    for (int end = 0; end < 2; ++end) {
      points[end] = (1.0 - time) * motion.a_before[end] + time * motion.a_after[end];
      points[2 + end] = (1.0 - time) * motion.b_before[end] + time * motion.b_after[end];
    }
  }

  const int steps_;
  const std::vector<HardMotion>* motions_ = nullptr;
  std::vector<std::size_t> free_;        // those without a contact so far
  std::vector<Eigen::Vector3d> points_;  // of each of them the ends of a, then of b
  std::vector<const Eigen::Vector3d*> a_;
  std::vector<const Eigen::Vector3d*> b_;
  std::vector<SegmentDistance> distances_;
};

}  // namespace

std::unique_ptr<MotionKernel> make_discrete_1_motions() {
  return std::make_unique<DiscreteMotions>(1);
}

std::unique_ptr<MotionKernel> make_discrete_10_motions() {
  return std::make_unique<DiscreteMotions>(10);
}

std::unique_ptr<MotionKernel> make_discrete_100_motions() {
  return std::make_unique<DiscreteMotions>(100);
}

}  // namespace fiber

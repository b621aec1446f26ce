#include "benchmark/kernels/makers.hpp"

namespace fiber {
namespace {

/// contact_times(), or one call for each motion.
class OwnMotions final : public MotionKernel {
 public:
  explicit OwnMotions(bool is_batch) : is_batch_(is_batch) {}

  bool keeps_tolerance() const override { return true; }

  void prepare(const std::vector<HardMotion>& motions) override {
    queries_.clear();
    for (const HardMotion& motion : motions) {
      queries_.push_back(motion.motions());
    }
  }

  void run(std::size_t first, std::size_t count, ContactTime* times) override {
    if (is_batch_) {
      contact_times(&queries_[first], count, tolerance(), times);
      return;
    }
    for (std::size_t i = 0; i < count; ++i) {
      times[i] = contact_time(queries_[first + i], tolerance());
    }
  }

 private:
  const bool is_batch_;
  std::vector<SegmentMotions> queries_;
};

}  // namespace

std::unique_ptr<MotionKernel> make_own_motions() { return std::make_unique<OwnMotions>(true); }

std::unique_ptr<MotionKernel> make_own_single_motions() {
  return std::make_unique<OwnMotions>(false);
}

}  // namespace fiber

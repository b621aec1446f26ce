#include <cmath>

#include "benchmark/kernels/makers.hpp"
#include "fiber_proximity/geometry/segment_distance.hpp"

namespace fiber {
namespace {

/// Our kernels: each decides about contacts as its bounds allow.
class OwnPairs : public PairKernel {
 public:
  explicit OwnPairs(Kernel kernel) : kernel_(kernel) {}

  void prepare(const std::vector<HardPair>& pairs) override { pairs_ = &pairs; }

  void run(std::size_t first, std::size_t count, double* distances) override {
    for (std::size_t i = 0; i < count; ++i) {
      const HardPair& pair = (*pairs_)[first + i];
      distances[i] = segment_distance(kernel_, pair.p0, pair.p1, pair.q0, pair.q1).distance;
    }
  }

  PairAnswer answer(std::size_t index) final {
    const HardPair& pair = (*pairs_)[index];
    const SegmentDistance found = one(index);
    return {found.distance, found.lower(), found.upper(), is_contact(pair, found)};
  }

 protected:
  const std::vector<HardPair>& pairs() const { return *pairs_; }

 private:
  virtual SegmentDistance one(std::size_t index) const {
    const HardPair& pair = (*pairs_)[index];
    return segment_distance(kernel_, pair.p0, pair.p1, pair.q0, pair.q1);
  }

  bool is_contact(const HardPair& pair, const SegmentDistance& found) const {
    const auto& [p0, p1, q0, q1, radius_a, radius_b] = pair;
    const ContactLimit limit{radius_a, radius_b, 0.0};
    switch (kernel_) {
      case Kernel::ROBUST:
        return gap_at_most(found, p0, p1, q0, q1, limit);
      case Kernel::EXACT:
        break;
    }
    return exact_gap_at_most(p0, p1, q0, q1, limit);
  }

  Kernel kernel_;
  const std::vector<HardPair>* pairs_ = nullptr;
};

/// Those that take many pairs at once, in the lanes of a register.
class OwnBatchPairs final : public OwnPairs {
 public:
  using Batch = void (*)(const Eigen::Vector3d* const* a, const Eigen::Vector3d* const* b,
                         std::size_t count, SegmentDistance* distances);

  OwnBatchPairs(Kernel kernel, Batch batch) : OwnPairs(kernel), batch_(batch) {}

  void prepare(const std::vector<HardPair>& pairs) override {
    OwnPairs::prepare(pairs);
    points_.clear();
    for (const HardPair& pair : pairs) {
      points_.insert(points_.end(), {pair.p0, pair.p1, pair.q0, pair.q1});
    }
    a_.clear();
    b_.clear();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      a_.push_back(&points_[4 * i]);
      b_.push_back(&points_[4 * i + 2]);
    }
    found_.resize(pairs.size());
  }

  void run(std::size_t first, std::size_t count, double* distances) override {
    batch_(&a_[first], &b_[first], count, found_.data());
    for (std::size_t i = 0; i < count; ++i) {
      distances[i] = found_[i].distance;
    }
  }

 private:
  SegmentDistance one(std::size_t index) const override {
    SegmentDistance found;
    batch_(&a_[index], &b_[index], 1, &found);
    return found;
  }

  Batch batch_;
  std::vector<Eigen::Vector3d> points_;  // of every pair p0, p1, q0, q1
  std::vector<const Eigen::Vector3d*> a_;
  std::vector<const Eigen::Vector3d*> b_;
  std::vector<SegmentDistance> found_;
};

}  // namespace

std::unique_ptr<PairKernel> make_robust_pairs() {
  return std::make_unique<OwnPairs>(Kernel::ROBUST);
}

std::unique_ptr<PairKernel> make_robust_batch_pairs() {
  return std::make_unique<OwnBatchPairs>(Kernel::ROBUST, segment_distances);
}

std::unique_ptr<PairKernel> make_exact_pairs() { return std::make_unique<OwnPairs>(Kernel::EXACT); }

}  // namespace fiber

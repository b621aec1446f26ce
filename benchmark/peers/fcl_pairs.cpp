#include <fcl/narrowphase/distance.h>

#include "benchmark/kernels/makers.hpp"
#include "benchmark/peers/fcl_capsule.hpp"

namespace fiber {
namespace {

/// fcl::distance() of two capsules in poses. Unsigned, FCL takes its own algorithm for two
/// capsules; signed, GJK, and EPA where they overlap, as for all other shapes.
class FclPairs final : public CapsulePairs<FclCapsule> {
 public:
  explicit FclPairs(bool is_signed) { request_.enable_signed_distance = is_signed; }

  void run(std::size_t first, std::size_t count, double* distances) override {
    for (std::size_t i = 0; i < count; ++i) {
      try {
        distances[i] = gap(first + i);
      } catch (const std::exception&) {  // EPA gives up
        distances[i] = std::numeric_limits<double>::quiet_NaN();
      }
    }
  }

 private:
  double gap(std::size_t index) override {
    fcl::DistanceResultd result;
    fcl::distance(&a_[index].capsule, a_[index].pose, &b_[index].capsule, b_[index].pose, request_,
                  result);
    return result.min_distance;
  }

  fcl::DistanceRequestd request_;
};

}  // namespace

std::unique_ptr<PairKernel> make_fcl_capsule_pairs() { return std::make_unique<FclPairs>(false); }

std::unique_ptr<PairKernel> make_fcl_gjk_pairs() { return std::make_unique<FclPairs>(true); }

}  // namespace fiber

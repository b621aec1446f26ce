#define CGAL_USE_GMP
#define CGAL_USE_MPFR
#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/squared_distance_3.h>

#include <algorithm>
#include <cmath>

#include "benchmark/kernels/makers.hpp"

namespace fiber {
namespace {

using Exact = CGAL::Exact_predicates_exact_constructions_kernel;

Exact::Point_3 to_point(const Eigen::Vector3d& point) { return {point.x(), point.y(), point.z()}; }

/// A power of two [m] that brings coordinates to where their squares are numbers in double; 1 if
/// they are there.
double scale_of(const HardPair& pair) {
  double largest = 0.0;
  for (const Eigen::Vector3d& point : {pair.p0, pair.p1, pair.q0, pair.q1}) {
    largest = std::max(largest, point.cwiseAbs().maxCoeff());
  }
  constexpr double safe = 0x1p300;
  return largest > safe || (largest > 0.0 && largest < 1.0 / safe)
             ? std::ldexp(1.0, std::max(std::ilogb(largest), -1022))
             : 1.0;
}

/// CGAL::squared_distance of two segments with exact numbers, GMP's rationals behind intervals. A
/// distance needs the rational, as the interval has lost some digits; it is its root in double. A
/// decision mostly gets by with the interval.
class CgalPairs final : public PairKernel {
 public:
  void prepare(const std::vector<HardPair>& pairs) override {
    pairs_ = &pairs;
    a_.clear();
    b_.clear();
    scales_.clear();
    for (const HardPair& pair : pairs) {
      const double scale = scale_of(pair);
      a_.emplace_back(to_point(pair.p0 / scale), to_point(pair.p1 / scale));
      b_.emplace_back(to_point(pair.q0 / scale), to_point(pair.q1 / scale));
      scales_.push_back(scale);
    }
  }

  void run(std::size_t first, std::size_t count, double* distances) override {
    for (std::size_t i = 0; i < count; ++i) {
      distances[i] = distance(first + i);
    }
  }

  PairAnswer answer(std::size_t index) override {
    const HardPair& pair = (*pairs_)[index];
    const Exact::FT sum = (Exact::FT(pair.radius_a) + Exact::FT(pair.radius_b)) / scales_[index];
    PairAnswer answer;
    answer.distance = distance(index);
    answer.contact = CGAL::squared_distance(a_[index], b_[index]) <= sum * sum;
    return answer;
  }

 private:
  double distance(std::size_t index) const {
    return scales_[index] *
           std::sqrt(CGAL::to_double(CGAL::exact(CGAL::squared_distance(a_[index], b_[index]))));
  }

  const std::vector<HardPair>* pairs_ = nullptr;
  std::vector<Exact::Segment_3> a_;
  std::vector<Exact::Segment_3> b_;
  std::vector<double> scales_;
};

}  // namespace

std::unique_ptr<PairKernel> make_cgal_pairs() { return std::make_unique<CgalPairs>(); }

}  // namespace fiber

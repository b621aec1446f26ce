#include <algorithm>
#include <cmath>

#include "benchmark/kernels/makers.hpp"
#include "benchmark/kernels/textbook.hpp"

namespace fiber {

double textbook_distance(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                         const Eigen::Vector3d& q0, const Eigen::Vector3d& q1) {
  constexpr double epsilon = std::numeric_limits<double>::epsilon();  // of squared lengths [m²]
  const Eigen::Vector3d u = p1 - p0;
  const Eigen::Vector3d v = q1 - q0;
  const Eigen::Vector3d w = p0 - q0;
  const double a = u.dot(u);
  const double e = v.dot(v);
  const double f = v.dot(w);
  double s = 0.0;
  double t = 0.0;
  if (a <= epsilon && e <= epsilon) {
    return w.norm();
  }
  if (a <= epsilon) {
    t = std::clamp(f / e, 0.0, 1.0);
  } else {
    const double c = u.dot(w);
    if (e <= epsilon) {
      s = std::clamp(-c / a, 0.0, 1.0);
    } else {
      const double b = u.dot(v);
      const double determinant = a * e - b * b;
      if (determinant != 0.0) {
        s = std::clamp((b * f - c * e) / determinant, 0.0, 1.0);
      }
      t = (b * s + f) / e;
      if (t < 0.0) {
        t = 0.0;
        s = std::clamp(-c / a, 0.0, 1.0);
      } else if (t > 1.0) {
        t = 1.0;
        s = std::clamp((b - c) / a, 0.0, 1.0);
      }
    }
  }
  const Eigen::Vector3d p = p0 + s * u;
  const Eigen::Vector3d q = q0 + t * v;
  return (p - q).norm();
}

namespace {

class TextbookPairs final : public PairKernel {
 public:
  void prepare(const std::vector<HardPair>& pairs) override { pairs_ = &pairs; }

  void run(std::size_t first, std::size_t count, double* distances) override {
    for (std::size_t i = 0; i < count; ++i) {
      distances[i] = distance((*pairs_)[first + i]);
    }
  }

  PairAnswer answer(std::size_t index) override {
    const HardPair& pair = (*pairs_)[index];
    PairAnswer answer;
    answer.distance = distance(pair);
    answer.contact = answer.distance <= pair.radius_a + pair.radius_b;
    return answer;
  }

 private:
  static double distance(const HardPair& pair) {
    return textbook_distance(pair.p0, pair.p1, pair.q0, pair.q1);
  }

  const std::vector<HardPair>* pairs_ = nullptr;
};

}  // namespace

std::unique_ptr<PairKernel> make_textbook_pairs() { return std::make_unique<TextbookPairs>(); }

}  // namespace fiber

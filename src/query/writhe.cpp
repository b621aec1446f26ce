#include "fiber_proximity/query/writhe.hpp"

#include <algorithm>
#include <numeric>

#include "src/geometry/gauss_integral.hpp"
#include "src/query/for_each_of.hpp"

namespace fiber {

double writhe(const std::vector<Eigen::Vector3d>& points, CurveEnds ends) {
  const std::size_t count = points.size();
  const std::size_t segments =
      ends == CurveEnds::CLOSED ? count : std::max(count, std::size_t{1}) - 1;
  std::vector<double> sums(segments, 0.0);  // by segment, so that threads do not change the order
  for_each_of(segments, [&](std::size_t i) {
    for (std::size_t j = i + 2; j < segments; ++j) {
      sums[i] += gauss_integral(points[i], points[i + 1], points[j], points[(j + 1) % count]);
    }
  });
  return 2.0 * std::accumulate(sums.begin(), sums.end(), 0.0);
}

}  // namespace fiber

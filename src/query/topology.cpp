#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "fiber_proximity/query/crossings.hpp"
#include "src/geometry/gauss_integral.hpp"
#include "src/query/threads.hpp"

namespace fiber {
namespace {

/// The fibres with the first point of each once more at its end.
FiberAssembly closed(const FiberAssembly& fibers) {
  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint32_t> offsets{0};
  points.reserve(fibers.point_count() + fibers.fiber_count());
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const auto first = fibers.points().begin() + fibers.offsets()[fiber];
    const auto end = fibers.points().begin() + fibers.offsets()[fiber + 1];
    points.insert(points.end(), first, end);
    points.push_back(*first);
    offsets.push_back(static_cast<std::uint32_t>(points.size()));
  }
  return {std::move(points), std::move(offsets), {0.0}};
}

}  // namespace

std::vector<LinkingNumber> linking_numbers(const FiberAssembly& fibers) {
  // Any direction does. Along this one little is seen edge-on, which would take integers to decide.
  View view;
  view.direction = {0.3127, -0.5471, -0.7764};
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::int64_t> sums;
  for (const Crossing& crossing : find_crossings(closed(fibers), view)) {
    if (crossing.fiber_a != crossing.fiber_b && crossing.a_is_over) {
      sums[{crossing.fiber_a, crossing.fiber_b}] += crossing.sign;
    }
  }
  std::vector<LinkingNumber> numbers;
  for (const auto& [pair, sum] : sums) {
    if (sum != 0) {
      numbers.push_back({pair.first, pair.second, sum});
    }
  }
  return numbers;
}

std::int64_t linking_number(const std::vector<Eigen::Vector3d>& curve_a,
                            const std::vector<Eigen::Vector3d>& curve_b) {
  std::vector<Eigen::Vector3d> points = curve_a;
  points.insert(points.end(), curve_b.begin(), curve_b.end());
  const auto middle = static_cast<std::uint32_t>(curve_a.size());
  const auto end = static_cast<std::uint32_t>(points.size());
  const std::vector<LinkingNumber> numbers =
      linking_numbers(FiberAssembly(std::move(points), {0, middle, end}, {0.0}));
  return numbers.empty() ? 0 : numbers.front().value;
}

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

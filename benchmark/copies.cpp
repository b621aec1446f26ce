#include "benchmark/copies.hpp"

#include <Eigen/Geometry>
#include <cassert>
#include <stdexcept>
#include <string>
#include <utility>

namespace fiber {
namespace {

/// Size of the box around the fibres, and a hundredth of it, so that copies do not touch [m].
Eigen::Vector3d spacing(const FiberAssembly& fibers) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : fibers.points()) {
    box.extend(point);
  }
  constexpr double with_gap = 1.01;
  return with_gap * box.sizes().array() + 2.0 * with_gap * fibers.largest_radius();
}

std::uint32_t cube_root_rounded_up(std::uint32_t value) {
  std::uint32_t root = 1;
  while (std::uint64_t{root} * root * root < value) {
    ++root;
  }
  return root;
}

FiberAssembly repeat(const FiberAssembly& fibers, std::uint32_t copies,
                     const Eigen::Vector3d& step) {
  const std::uint32_t side = cube_root_rounded_up(copies);
  const bool radius_shared = fibers.radius_per() == RadiusPer::ASSEMBLY;
  std::vector<Eigen::Vector3d> points;
  std::vector<std::uint32_t> offsets{0};
  std::vector<double> radii(fibers.radii().begin(),
                            fibers.radii().begin() + (radius_shared ? 1 : 0));
  points.reserve(copies * fibers.point_count());
  offsets.reserve(copies * fibers.fiber_count() + 1);
  for (std::uint32_t copy = 0; copy < copies; ++copy) {
    using Cell = Eigen::Matrix<std::uint32_t, 3, 1>;
    const Cell cell(copy % side, copy / side % side, copy / side / side);
    const Eigen::Vector3d shift = cell.cast<double>().cwiseProduct(step);
    const auto first = static_cast<std::uint32_t>(points.size());
    for (const Eigen::Vector3d& point : fibers.points()) {
      points.push_back(point + shift);
    }
    for (std::size_t fiber = 1; fiber <= fibers.fiber_count(); ++fiber) {
      offsets.push_back(first + fibers.offsets()[fiber]);
    }
    if (!radius_shared) {
      radii.insert(radii.end(), fibers.radii().begin(), fibers.radii().end());
    }
  }
  return {std::move(points), std::move(offsets), std::move(radii)};
}

}  // namespace

Scene side_by_side(Scene scene, std::uint32_t copies) {
  assert(copies > 0);
  if (copies == 1) {
    return scene;
  }
  const FiberAssembly first = scene(0);
  constexpr std::uint64_t max_points = 0x7FFF'FFFF;
  if (std::uint64_t{copies} * first.point_count() > max_points) {
    throw std::invalid_argument("copies is " + std::to_string(copies) + ", of this scene at most " +
                                std::to_string(max_points / first.point_count()) + " are possible");
  }
  return [scene = std::move(scene), copies, step = spacing(first)](std::uint32_t frame) {
    return repeat(scene(frame), copies, step);
  };
}

}  // namespace fiber

#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/scenes/scene.hpp"
#include "test/support/random.hpp"

namespace fiber::test {

/// A scene small enough for brute force: a few of its fibres, and of each a stretch of the same
/// number of segments, at most 1 380 in all. Its seed and what is left out are random.
class SmallScene {
 public:
  /// @param thick a radius of 0.4 % of the extent, so that even the few fibres of a sparse scene
  ///        touch, instead of the scene's own
  SmallScene(const std::string& name, bool shuffle, bool thick, Random& random) {
    const auto min_fibers = static_cast<std::size_t>(random.integer(2, 12));
    const auto seed = static_cast<std::uint64_t>(random.integer(0, 1'000'000));
    scene_ = with_fibers(min_fibers, name, {0x1p-20, seed, shuffle});
    const FiberAssembly whole = scene_(0);
    int shortest = static_cast<int>(whole.point_count());
    for (std::size_t fiber = 0; fiber < whole.fiber_count(); ++fiber) {
      const std::uint32_t points = whole.offsets()[fiber + 1] - whole.offsets()[fiber];
      shortest = std::min(shortest, static_cast<int>(points) - 1);
    }
    segments_ = std::min(random.integer(10, 60), shortest);
    const int longest_stride = shortest / segments_;
    stride_ = random.chance(0.5) ? longest_stride : random.integer(1, longest_stride);
    first_ = random.integer(0, shortest - segments_ * stride_);
    radii_ = whole.radii();
    if (thick) {
      radii_ = {0.004 * extent((*this)(0))};
    }
  }

  /// Its fibres at a frame, of the same topology at all of them.
  FiberAssembly operator()(std::uint32_t frame) const {
    const FiberAssembly whole = scene_(frame);
    std::vector<Eigen::Vector3d> points;
    std::vector<std::uint32_t> offsets{0};
    for (std::size_t fiber = 0; fiber < whole.fiber_count(); ++fiber) {
      const std::size_t first = whole.offsets()[fiber] + static_cast<std::size_t>(first_);
      for (int i = 0; i <= segments_; ++i) {
        points.push_back(whole.points()[first + static_cast<std::size_t>(i * stride_)]);
      }
      offsets.push_back(static_cast<std::uint32_t>(points.size()));
    }
    return {std::move(points), std::move(offsets), radii_};
  }

  /// [m] of the thickest fibre.
  double radius() const { return *std::max_element(radii_.begin(), radii_.end()); }

 private:
  /// The scene at the smallest scale, in powers of two, that has so many fibres; whole if none has.
  static Scene with_fibers(std::size_t least, const std::string& name, SceneOptions options) {
    while (options.scale < 1.0 && make_scene(name, options)(0).fiber_count() < least) {
      options.scale *= 2.0;
    }
    return make_scene(name, options);
  }

  static double extent(const FiberAssembly& fibers) {
    double largest = 0.0;
    for (const Eigen::Vector3d& point : fibers.points()) {
      largest = std::max(largest, (point - fibers.points().front()).cwiseAbs().maxCoeff());
    }
    return largest;
  }

  Scene scene_;
  int segments_ = 0;  // of a fibre
  int stride_ = 1;    // in points of the scene
  int first_ = 0;     // point of a fibre
  std::vector<double> radii_;
};

}  // namespace fiber::test

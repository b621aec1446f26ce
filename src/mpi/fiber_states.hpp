#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/mpi/box_tree.hpp"
#include "src/mpi/local_fibers.hpp"

namespace fiber {

/// The largest radius of segments that follow each other [m].
/// @param begin, end the first point and the last one
inline double largest_radius(const FiberAssembly& fibers, std::uint64_t begin, std::uint64_t end) {
  const std::vector<double>& radii = fibers.radii();
  return radii.size() == 1 ? radii.front()
                           : *std::max_element(radii.data() + begin, radii.data() + end);
}

/// Fibres as they are, or before and after a motion, of the same runs and points then.
struct FiberStates {
  const LocalFibers& before;
  const LocalFibers* after = nullptr;  // none: they stay

  /// Calls with the fibres of each state.
  template <class Call>
  void for_each(const Call& call) const {
    call(before.fibers());
    if (after != nullptr) {
      call(after->fibers());
    }
  }

  /// Begins to bring points to the cache.
  void fetch(std::uint64_t begin, std::uint64_t end) const {
    for_each([&](const FiberAssembly& fibers) {
      const auto* const first = reinterpret_cast<const char*>(fibers.points().data() + begin);
      const auto* const last = reinterpret_cast<const char*>(fibers.points().data() + end + 1);
      constexpr std::ptrdiff_t line = 64;  // of the cache [byte]
      for (const char* byte = first; byte < last; byte += line) {
        __builtin_prefetch(byte);
      }
    });
  }

  /// A box around consecutive segments during the whole motion.
  /// @param begin, end the first point and the last one
  Box3d box_around(std::uint64_t begin, std::uint64_t end) const {
    const Eigen::Vector3d& first = before.fibers().points()[begin];
    Eigen::Array3d lower = first;
    Eigen::Array3d upper = first;
    double radius = 0.0;
    for_each([&](const FiberAssembly& fibers) {
      const Eigen::Vector3d* const points = fibers.points().data();
      for (std::uint64_t p = begin; p <= end; ++p) {
        lower = lower.min(points[p].array());
        upper = upper.max(points[p].array());
      }
      radius = std::max(radius, largest_radius(fibers, begin, end));
    });
    return inflated({lower.matrix().eval(), upper.matrix().eval()}, radius);
  }
};

}  // namespace fiber

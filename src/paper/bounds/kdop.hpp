#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "src/bounds/aabb.hpp"
#include "src/bounds/bounding_volume.hpp"

namespace fiber {

/// Slabs are kept four at a time, one SIMD register.
constexpr int slabs_per_group = 4;

/// The directions all k-DOPs of a hierarchy share, as a structure of arrays. Where there is room
/// for more than k/2 the last direction fills it: its slabs are copies, and change nothing.
template <int Groups>
struct KdopDirections {
  static constexpr int padded_count = Groups * slabs_per_group;

  alignas(16) std::array<float, padded_count> x{};
  alignas(16) std::array<float, padded_count> y{};
  alignas(16) std::array<float, padded_count> z{};
  int count = 0;  ///< k/2

  KdopDirections() = default;

  /// @param directions unit vectors, at least 1 and at most padded_count of them
  explicit KdopDirections(const std::vector<Eigen::Vector3d>& directions)
      : count(static_cast<int>(directions.size())) {
    for (int i = 0; i < padded_count; ++i) {
      const Eigen::Vector3f direction = directions[std::min(i, count - 1)].cast<float>();
      x[i] = direction.x();
      y[i] = direction.y();
      z[i] = direction.z();
    }
  }

  Eigen::Vector3d direction(int i) const {
    return Eigen::Vector3f(x[i], y[i], z[i]).cast<double>();
  }
};

/// Discrete orientation polytope (paper, Sect. 4.2): k/2 slabs with the hierarchy's directions.
template <int Groups>
struct Kdop {
  using Parameters = KdopDirections<Groups>;
  static constexpr int padded_count = Parameters::padded_count;

  alignas(16) std::array<float, padded_count> lower{};  ///< [m] along the directions
  alignas(16) std::array<float, padded_count> upper{};  ///< [m] along the directions
};

/// The closed form of Sect. 4.2.3: the plane that supports a capsule along n touches the cap of the
/// end point further along n, a radius beyond it.
template <int Groups>
void fit(Kdop<Groups>& dop, const Capsule& capsule, const KdopDirections<Groups>& directions) {
  const RoundedCapsule rounded(capsule);
  const float reach = rounded.representable ? rounded.radius + rounded.padding
                                            : std::numeric_limits<float>::infinity();
  for (int i = 0; i < Kdop<Groups>::padded_count; ++i) {
    const float start = directions.x[i] * rounded.p0.x() + directions.y[i] * rounded.p0.y() +
                        directions.z[i] * rounded.p0.z();
    const float end = directions.x[i] * rounded.p1.x() + directions.y[i] * rounded.p1.y() +
                      directions.z[i] * rounded.p1.z();
    dop.lower[i] = std::min(start, end) - reach;
    dop.upper[i] = std::max(start, end) + reach;
  }
}

template <int Groups>
Kdop<Groups> merge(const Kdop<Groups>& a, const Kdop<Groups>& b) {
  Kdop<Groups> dop;
  for (int i = 0; i < Kdop<Groups>::padded_count; ++i) {
    dop.lower[i] = std::min(a.lower[i], b.lower[i]);
    dop.upper[i] = std::max(a.upper[i], b.upper[i]);
  }
  return dop;
}

/// Wrapping equals layering (Sect. 4.2.2): both give the smallest slabs.
template <int Groups>
void fit(Kdop<Groups>& dop, const CapsuleRun& run, const KdopDirections<Groups>& directions) {
  fit(dop, *run.first, directions);
  for (const Capsule& capsule : run) {
    Kdop<Groups> other;
    fit(other, capsule, directions);
    dop = merge(dop, other);
  }
}

/// Separated if any slab is; a group of four at a time, and no further than the first that is.
template <int Groups>
bool overlaps(const Kdop<Groups>& a, const Kdop<Groups>& b, float margin) {
  for (int group = 0; group < Kdop<Groups>::padded_count; group += slabs_per_group) {
    int separated = 0;
    for (int i = group; i < group + slabs_per_group; ++i) {
      separated |= static_cast<int>(a.lower[i] - b.upper[i] > margin) |
                   static_cast<int>(b.lower[i] - a.upper[i] > margin);
    }
    if (separated != 0) {
      return false;
    }
  }
  return true;
}

/// The widest gap of a slab.
template <int Groups>
float distance_lower_bound(const Kdop<Groups>& a, const Kdop<Groups>& b) {
  float widest = 0.0F;
  for (int i = 0; i < Kdop<Groups>::padded_count; ++i) {
    widest = std::max(widest, std::max(a.lower[i] - b.upper[i], b.lower[i] - a.upper[i]));
  }
  return widest;
}

template <int Groups>
bool contains(const Kdop<Groups>& dop, const Capsule& capsule,
              const KdopDirections<Groups>& directions) {
  for (int i = 0; i < directions.count; ++i) {
    const double start = directions.direction(i).dot(capsule.p0);
    const double end = directions.direction(i).dot(capsule.p1);
    if (std::min(start, end) - capsule.radius < static_cast<double>(dop.lower[i]) ||
        std::max(start, end) + capsule.radius > static_cast<double>(dop.upper[i])) {
      return false;
    }
  }
  return true;
}

/// Volume and box of the polytope |slabs|: intersection of the half spaces [m³], [m].
/// @param directions one per slab
struct PolytopeMeasure {
  double volume = 0.0;
  Aabb box;
};
PolytopeMeasure measure_polytope(const std::vector<Eigen::Vector3d>& directions,
                                 const std::vector<double>& lower,
                                 const std::vector<double>& upper);

template <int Groups>
PolytopeMeasure measure(const Kdop<Groups>& dop, const KdopDirections<Groups>& directions) {
  std::vector<Eigen::Vector3d> normals;
  for (int i = 0; i < directions.count; ++i) {
    normals.push_back(directions.direction(i));
  }
  return measure_polytope(normals, {dop.lower.begin(), dop.lower.begin() + directions.count},
                          {dop.upper.begin(), dop.upper.begin() + directions.count});
}

template <int Groups>
double volume(const Kdop<Groups>& dop, const KdopDirections<Groups>& directions) {
  return measure(dop, directions).volume;
}

template <int Groups>
Aabb bounding_box(const Kdop<Groups>& dop, const KdopDirections<Groups>& directions) {
  return measure(dop, directions).box;
}

/// The k-DOP's own directions, longest extent first.
template <int Groups>
std::vector<SplitAxis> split_axes(const Kdop<Groups>& dop, const CapsuleRun& /*run*/,
                                  const KdopDirections<Groups>& directions) {
  std::vector<SplitAxis> axes;
  for (int i = 0; i < directions.count; ++i) {
    const auto low = static_cast<double>(dop.lower[i]);
    const auto high = static_cast<double>(dop.upper[i]);
    axes.push_back({directions.direction(i), 0.5 * (low + high), high - low});
  }
  std::stable_sort(axes.begin(), axes.end(),
                   [](const SplitAxis& x, const SplitAxis& y) { return x.extent > y.extent; });
  return axes;
}

static_assert(IsBoundingVolume<Kdop<2>>::value, "Kdop must keep the contract");

}  // namespace fiber

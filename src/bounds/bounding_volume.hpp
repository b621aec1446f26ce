#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// A run of consecutive capsules in memory: what a wrapped or spatial node encloses.
struct CapsuleRun {
  const Capsule* first = nullptr;
  std::size_t size = 0;

  const Capsule* begin() const { return first; }
  const Capsule* end() const { return first + size; }
};

/// A capsule in single precision, and by how much a volume around it must be padded so that its
/// tests err on the safe side only.
///
/// With u = 2⁻²⁴, rounding an end point, projecting it onto a rounded unit direction, adding the
/// radius and subtracting two such numbers err by less than 12 u of the largest magnitude involved;
/// the padding is 16 u of it: a micrometre in a scene of a metre. It covers the rounding of the
/// narrow phase in double precision many times over. The smallest normal float keeps it alive where
/// the product would underflow.
struct RoundedCapsule {
  /// Magnitudes up to here have squares and sums of squares in float's range [m].
  static constexpr double largest_magnitude = 1e18;

  Eigen::Vector3f p0;
  Eigen::Vector3f p1;
  float radius = 0.0F;   ///< [m]
  float padding = 0.0F;  ///< [m]

  /// False beyond largest_magnitude: a volume must then enclose everything.
  bool representable = false;

  explicit RoundedCapsule(const Capsule& capsule)
      : p0(Eigen::Vector3f::Zero()), p1(Eigen::Vector3f::Zero()) {
    const double magnitude =
        std::max(capsule.p0.cwiseAbs().maxCoeff(), capsule.p1.cwiseAbs().maxCoeff()) +
        capsule.radius;
    representable = magnitude <= largest_magnitude;
    if (!representable) {
      return;
    }
    p0 = capsule.p0.cast<float>();
    p1 = capsule.p1.cast<float>();
    radius = static_cast<float>(capsule.radius);
    padding = static_cast<float>(magnitude) * 0x1p-20F + std::numeric_limits<float>::min();
  }
};

/// The most that squares below the normal range of float may err by, as their digits run out [m²].
constexpr float squared_underflow = std::numeric_limits<float>::min();

/// Parameters of a volume that has none.
struct NoParameters {};

/// The contract of a bounding volume: a value type, the type Volume::Parameters of what all volumes
/// of a hierarchy have in common, and free functions found beside it.
///
///   void   fit(Volume&, const Capsule&, const Parameters&)     encloses the capsule
///   void   fit(Volume&, const CapsuleRun&, const Parameters&)  encloses them all, as tightly as
///   the
///                                                              volume can
///   Volume merge(const Volume&, const Volume&)                 encloses both
///   bool   overlaps(const Volume&, const Volume&, float margin)
///          may be true too often, never false for volumes whose contents come within the margin
///   float  distance_lower_bound(const Volume&, const Volume&)
///          never above the distance of the contents [m]; at most 0 when the volumes overlap
///   bool   contains(const Volume&, const Capsule&, const Parameters&)
///   double volume(const Volume&, const Parameters&)            [m³]
///   Aabb   bounding_box(const Volume&, const Parameters&)      for drawing
///   split_axes(const Volume&, const CapsuleRun&, const Parameters&)
///          the directions a spatial hierarchy tries to split along, longest extent first
///
/// Volumes are stored in single precision, relative to the origin of their hierarchy, and padded in
/// `fit` (see RoundedCapsule): a tree over them answers exactly what brute force answers.
template <class Volume, class = void>
struct IsBoundingVolume : std::false_type {};

template <class Volume>
struct IsBoundingVolume<
    Volume,
    std::void_t<
        decltype(fit(std::declval<Volume&>(), std::declval<const Capsule&>(),
                     std::declval<const typename Volume::Parameters&>())),
        decltype(fit(std::declval<Volume&>(), std::declval<const CapsuleRun&>(),
                     std::declval<const typename Volume::Parameters&>())),
        decltype(merge(std::declval<const Volume&>(), std::declval<const Volume&>())),
        decltype(overlaps(std::declval<const Volume&>(), std::declval<const Volume&>(), 0.0F)),
        decltype(distance_lower_bound(std::declval<const Volume&>(),
                                      std::declval<const Volume&>())),
        decltype(contains(std::declval<const Volume&>(), std::declval<const Capsule&>(),
                          std::declval<const typename Volume::Parameters&>())),
        decltype(volume(std::declval<const Volume&>(),
                        std::declval<const typename Volume::Parameters&>())),
        decltype(bounding_box(std::declval<const Volume&>(),
                              std::declval<const typename Volume::Parameters&>())),
        decltype(split_axes(std::declval<const Volume&>(), std::declval<const CapsuleRun&>(),
                            std::declval<const typename Volume::Parameters&>()))>>
    : std::true_type {};

/// One direction to split along and where its middle is.
struct SplitAxis {
  Eigen::Vector3d direction;
  double middle = 0.0;  ///< [m] along the direction
  double extent = 0.0;  ///< [m]
};

/// A margin [m] as the volumes take it: rounded up to single precision; or a depth below 0.
inline float round_up(double margin) {
  if (margin > std::numeric_limits<float>::max()) {
    return std::numeric_limits<float>::infinity();
  }
  if (margin < std::numeric_limits<float>::lowest()) {
    return std::numeric_limits<float>::lowest();
  }
  const auto nearest = static_cast<float>(margin);
  return static_cast<double>(nearest) < margin
             ? std::nextafter(nearest, std::numeric_limits<float>::infinity())
             : nearest;
}

/// The volume of two neighbouring leaves in a layered hierarchy. Most volumes merge the leaves';
/// the oriented box overloads this to look at the segments themselves.
template <class Volume>
Volume merge_leaves(const Volume& a, const Volume& b, const Capsule& /*capsule_a*/,
                    const Capsule& /*capsule_b*/) {
  return merge(a, b);
}

/// The origin that a hierarchy of these fibres is relative to [m]: the first point, near all others
/// in any scene single precision can serve, and the same for the same input.
inline Eigen::Vector3d hierarchy_origin(const FiberAssembly& fibers) {
  return fibers.points().empty() ? Eigen::Vector3d::Zero() : fibers.points().front();
}

}  // namespace fiber

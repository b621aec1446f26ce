#pragma once

#include <type_traits>
#include <utility>
#include <vector>

#include "fiber_proximity/geometry/capsule.hpp"
#include "src/bounds/rounded_capsule.hpp"

namespace fiber {

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

/// A margin [m] as the volumes take it: rounded up to single precision.
float round_up(double margin);

/// The volume of two neighbouring leaves in a layered hierarchy. Most volumes merge the leaves';
/// the oriented box overloads this to look at the segments themselves.
template <class Volume>
Volume merge_leaves(const Volume& a, const Volume& b, const Capsule& /*capsule_a*/,
                    const Capsule& /*capsule_b*/) {
  return merge(a, b);
}

}  // namespace fiber

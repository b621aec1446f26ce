#pragma once

#include <type_traits>
#include <utility>

#include "fiber_proximity/geometry/capsule.hpp"

namespace fiber {

/// The contract of a bounding volume: a value type and free functions found beside it.
///
///   void  fit(Volume&, const Capsule&)                    encloses the capsule
///   Volume merge(const Volume&, const Volume&)            encloses both
///   bool  overlaps(const Volume&, const Volume&, float margin)
///         may be true too often, never false for volumes whose contents come within the margin
///   float distance_lower_bound(const Volume&, const Volume&)
///         never above the distance of the contents [m]; 0 when the volumes overlap
///   Aabb  bounding_box(const Volume&)                     for drawing
///
/// Volumes are stored in single precision, relative to the origin of their hierarchy. Each one pads
/// itself in `fit` by enough to cover its own rounding, that of the two tests, and that of the
/// distances the narrow phase computes in double: a tree over them answers exactly what brute force
/// answers.
template <class Volume, class = void>
struct IsBoundingVolume : std::false_type {};

template <class Volume>
struct IsBoundingVolume<
    Volume,
    std::void_t<decltype(fit(std::declval<Volume&>(), std::declval<const Capsule&>())),
                decltype(merge(std::declval<const Volume&>(), std::declval<const Volume&>())),
                decltype(overlaps(std::declval<const Volume&>(), std::declval<const Volume&>(),
                                  0.0F)),
                decltype(distance_lower_bound(std::declval<const Volume&>(),
                                              std::declval<const Volume&>()))>>
    : std::is_trivially_copyable<Volume> {};

/// A margin [m] as the volumes take it: rounded up to single precision.
float round_up(double margin);

}  // namespace fiber

#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <type_traits>
#include <vector>

#include "src/bounds/aabb.hpp"
#include "src/paper/bounds/direction_set.hpp"
#include "src/paper/bounds/kdop.hpp"
#include "src/paper/bounds/obb.hpp"
#include "src/paper/bounds/sphere.hpp"
#include "test/docs/cube.hpp"

namespace fiber::test {

/// The volumes that every typed suite is about: one line here adds one.
using VolumeTypes = testing::Types<Aabb, Kdop<1>, Kdop<3>, Kdop<25>, Obb, Sphere, Cube>;

/// Parameters to test a volume with: for k-DOPs the fewest directions their groups take.
template <class Volume>
const typename Volume::Parameters& parameters() {
  if constexpr (std::is_same_v<typename Volume::Parameters, NoParameters>) {
    static const NoParameters none;
    return none;
  } else {
    constexpr int directions = std::max(3, Volume::padded_count - slabs_per_group + 1);
    static const typename Volume::Parameters shared(grassmannian_directions(2 * directions));
    return shared;
  }
}

template <class Volume>
Volume fitted(const Capsule& capsule) {
  Volume volume;
  fit(volume, capsule, parameters<Volume>());
  return volume;
}

template <class Volume>
Volume fitted(const std::vector<Capsule>& capsules) {
  Volume volume;
  fit(volume, CapsuleRun{capsules.data(), capsules.size()}, parameters<Volume>());
  return volume;
}

}  // namespace fiber::test

#include "src/scenes/hard_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fiber_proximity/geometry/exact_distance.hpp"
#include "src/scenes/hard_pair_makers.hpp"

namespace fiber {
namespace {

/// Radii whose sum is the distance, give or take four units in the last place.
void make_touching(HardPair& pair, Random& random) {
  const double distance = exact_segment_distance(pair.p0, pair.p1, pair.q0, pair.q1).distance;
  double sum = distance;
  const int steps = static_cast<int>(random.uniform(0.0, 9.0)) - 4;
  const double towards = steps > 0 ? std::numeric_limits<double>::infinity() : 0.0;
  for (int i = 0; i < std::abs(steps); ++i) {
    sum = std::nextafter(sum, towards);
  }
  pair.radius_a = random.uniform(0.5, 1.0) * sum;
  pair.radius_b = sum - pair.radius_a;
}

}  // namespace

const std::vector<HardFamily>& hard_families() {
  static const std::vector<HardFamily> families = [] {
    std::vector<HardFamily> all;
    append_scales(all);
    append_angles(all);
    append_parallels(all);
    append_lengths(all);
    append_touches(all);
    return all;
  }();
  return families;
}

std::vector<HardPair> hard_pairs(const HardFamily& family, std::uint32_t count,
                                 std::uint64_t seed) {
  Random random(seed);
  std::vector<HardPair> pairs;
  pairs.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    pairs.push_back(family.make(random));
    make_touching(pairs.back(), random);
  }
  return pairs;
}

}  // namespace fiber

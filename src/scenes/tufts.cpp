// Hair that grows without limit: tufts of it, side by side on a square.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "src/scenes/hair.hpp"
#include "src/scenes/large_scenes.hpp"
#include "src/scenes/portable_math.hpp"
#include "src/scenes/scalp.hpp"
#include "src/scenes/scenes.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

struct Tufts {
  const HairStyle& style;  // of each of them
  double spacing;          // [m]
};

const Tufts tress_tufts{tress_b, 0.03};

/// Four locks each, whose roots are as dense as all others of hair.
const HairStyle four_locks{160,
                           64,
                           false,
                           {0.12, 0.06, {0.3, 0.1, -1.0}, {0.0, 0.0, 0.0}, 0.0, 0.0, 0.03, 0.0},
                           {0.01, 0.9, 0.0008},
                           {0.0025, 0.3, 0.04, 0.04, 0.15},
                           0.006};
const Tufts lock_tufts{four_locks, std::sqrt(four_locks.hair_count / hair_density)};

/// Hairs begin … end - 1 of so many. A tuft of which some are wanted is made as a whole.
FiberAssembly part_of_tufts(const Tufts& tufts, std::uint64_t count, std::uint64_t seed,
                            std::uint64_t begin, std::uint64_t end, std::uint32_t frame) {
  const HairStyle& style = tufts.style;
  const std::uint64_t hairs = style.hair_count;
  const std::uint64_t tuft_count = (count + hairs - 1) / hairs;
  const auto row =
      static_cast<std::uint64_t>(std::ceil(std::sqrt(static_cast<double>(tuft_count))));
  const std::uint64_t points_per_hair = style.segments + 1;
  std::vector<Vector3d> points;
  points.reserve((end - begin) * points_per_hair);
  for (std::uint64_t tuft = begin / hairs; tuft * hairs < end; ++tuft) {
    const std::uint64_t first = tuft * hairs;
    const auto here = static_cast<double>(std::min(hairs, count - first));
    const FiberAssembly fibers =
        hair(style, {here / style.hair_count, stream_seed(seed, tuft)}, frame);
    const std::uint64_t rows_before = tuft / row;
    const Vector3d place(tufts.spacing * static_cast<double>(tuft % row),
                         tufts.spacing * static_cast<double>(rows_before), 0.0);
    const std::uint64_t last = (std::min(end, first + hairs) - first) * points_per_hair;
    for (std::uint64_t i = (std::max(begin, first) - first) * points_per_hair; i < last; ++i) {
      points.push_back(fibers.points()[i] + place);
    }
  }
  return equal_fibers(std::move(points), style.segments + 1, hair_radius);
}

LargeScene scene_of_tufts(const Tufts& tufts, std::uint64_t segments, std::uint64_t seed) {
  const std::uint64_t count = (segments + tufts.style.segments - 1) / tufts.style.segments;
  const double row = tufts.style.path.length / tufts.spacing;
  const auto typical = static_cast<std::uint64_t>(std::lround(row * row * tufts.style.hair_count)) *
                       tufts.style.segments;
  return {count, tufts.style.segments, 2, typical,
          [=, &tufts](std::uint64_t begin, std::uint64_t end, std::uint32_t frame) {
            return part_of_tufts(tufts, count, seed, begin, end, frame);
          }};
}

}  // namespace

LargeScene many_tresses(std::uint64_t segments, std::uint64_t seed) {
  return scene_of_tufts(tress_tufts, segments, seed);
}

LargeScene many_locks(std::uint64_t segments, std::uint64_t seed) {
  return scene_of_tufts(lock_tufts, segments, seed);
}

}  // namespace fiber

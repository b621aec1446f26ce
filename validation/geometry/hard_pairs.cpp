#include "validation/geometry/hard_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "src/io/number.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;
using HardFamilies = std::vector<HardFamily>;

/// A power of ten, the same bits everywhere.
double power_of_ten(int exponent) {
  return parse_number<double>("1e" + std::to_string(exponent)).value_or(0.0);
}

/// Unrelated segments in a cube of 2 m.
HardPair generic_pair(Random& random) {
  HardPair pair;
  for (Vector3d* point : {&pair.p0, &pair.p1, &pair.q0, &pair.q1}) {
    *point = random.point_in_cube(-1.0, 1.0);
  }
  return pair;
}

/// Two segments of 1 m whose lines are this far apart [m] at this angle [rad, small].
HardPair crossing_pair(Random& random, double angle, double gap) {
  const Vector3d u = random.direction();
  const Vector3d side = perpendicular_unit(random.direction(), u);
  const Vector3d normal(u.y() * side.z() - u.z() * side.y(), u.z() * side.x() - u.x() * side.z(),
                        u.x() * side.y() - u.y() * side.x());
  const Vector3d v = u + angle * side;
  const Vector3d centre = random.point_in_cube(-1.0, 1.0);
  // Mostly, the lines cross inside both segments, or close to their ends.
  const double a = random.uniform(-1.2, 0.2);
  const double b = random.uniform(-1.2, 0.2);
  HardPair pair;
  pair.p0 = centre + a * u;
  pair.p1 = centre + (a + 1.0) * u;
  pair.q0 = centre + gap * normal + b * v;
  pair.q1 = centre + gap * normal + (b + 1.0) * v;
  return pair;
}

/// 0, tiny, or up to 0.1 m: all sizes alike.
double any_gap(Random& random) {
  const double kind = random.uniform(0.0, 1.0);
  const double gap = random.uniform(0.0, 0.1);
  return kind < 0.25 ? 0.0 : gap * power_of_ten(-static_cast<int>(random.uniform(0.0, 16.0)));
}

HardPair scaled(const HardPair& pair, double factor) {
  return {factor * pair.p0, factor * pair.p1, factor * pair.q0, factor * pair.q1, 0.0, 0.0};
}

HardPair shifted(const HardPair& pair, const Vector3d& shift) {
  return {pair.p0 + shift, pair.p1 + shift, pair.q0 + shift, pair.q1 + shift, 0.0, 0.0};
}

std::string numbered(const std::string& name, int exponent) {
  return name + "1e" + std::to_string(exponent);
}

HardPair denormal_pair(Random& random) {
  HardPair pair = generic_pair(random);
  for (Vector3d* point : {&pair.p0, &pair.p1, &pair.q0, &pair.q1}) {
    *point *= random.uniform(0.0, 1.0) < 0.5 ? 0x1p-1068 : 0x1p-1030;
  }
  return pair;
}

/// Along the line of the first segment from `from` to `to` of its length.
HardPair along_first(Random& random, double from, double to, const Vector3d& offset) {
  HardPair pair = generic_pair(random);
  const Vector3d u = pair.p1 - pair.p0;
  pair.q0 = pair.p0 + from * u + offset;
  pair.q1 = pair.p0 + to * u + offset;
  return pair;
}

/// Generic pairs, each changed in this way.
HardFamily changed(const std::string& name, const std::function<void(HardPair&)>& change) {
  return {name, [change](Random& random) {
            HardPair pair = generic_pair(random);
            change(pair);
            return pair;
          }};
}

void append_scales(HardFamilies& families) {
  families.push_back({"generic", generic_pair});
  for (const int exponent : {-300, -160, -80, -40, -20, -10, -3, 3, 10, 20, 40, 80, 149}) {
    const double factor = power_of_ten(exponent);
    families.push_back({numbered("scale_", exponent),
                        [=](Random& random) { return scaled(generic_pair(random), factor); }});
  }
  families.push_back({"denormal", denormal_pair});
}

void append_angles(HardFamilies& families) {
  for (int exponent = -1; exponent >= -16; --exponent) {
    const double angle = power_of_ten(exponent);
    const auto make = [=](Random& random) {
      const double gap = any_gap(random);
      return crossing_pair(random, angle, gap);
    };
    families.push_back({numbered("angle_", exponent), make});
    families.push_back({numbered("millimetres_angle_", exponent),
                        [=](Random& random) { return scaled(make(random), 1e-3); }});
  }
  for (const int exponent : {-80, 80}) {
    const double factor = power_of_ten(exponent);
    families.push_back({numbered("angle_1e-9_scale_", exponent), [=](Random& random) {
                          return scaled(crossing_pair(random, 1e-9, 1e-9), factor);
                        }});
  }
}

void append_parallels(HardFamilies& families) {
  families.push_back({"parallel_overlapping", [](Random& random) {
                        const Vector3d offset = 0.1 * random.direction();
                        const double from = random.uniform(-0.5, 0.5);
                        return along_first(random, from, from + random.uniform(0.5, 1.0), offset);
                      }});
  families.push_back({"parallel_disjoint", [](Random& random) {
                        const Vector3d offset = 0.1 * random.direction();
                        const double from = random.uniform(1.5, 2.0);
                        return along_first(random, from, from + random.uniform(0.5, 1.0), offset);
                      }});
  families.push_back({"collinear", [](Random& random) {
                        const double from = random.uniform(-2.0, 2.0);
                        return along_first(random, from, from + random.uniform(-1.0, 1.0),
                                           Vector3d::Zero());
                      }});
  families.push_back(changed("identical", [](HardPair& pair) {
    pair.q0 = pair.p0;
    pair.q1 = pair.p1;
  }));
  families.push_back(changed("reversed", [](HardPair& pair) {
    pair.q0 = pair.p1;
    pair.q1 = pair.p0;
  }));
}

void append_lengths(HardFamilies& families) {
  families.push_back(changed("one_zero_length", [](HardPair& pair) { pair.q1 = pair.q0; }));
  families.push_back(changed("both_zero_length", [](HardPair& pair) {
    pair.p1 = pair.p0;
    pair.q1 = pair.q0;
  }));
  for (const int exponent : {-300, -16, -8}) {
    const double ratio = power_of_ten(exponent);
    const auto make = [=](Random& random) {
      const double angle = random.uniform(0.1, 1.0);
      const double gap = any_gap(random);
      HardPair pair = crossing_pair(random, angle, gap);
      pair.q1 = pair.q0 + ratio * (pair.q1 - pair.q0);
      return pair;
    };
    families.push_back({numbered("length_ratio_", exponent), make});
    families.push_back({numbered("swapped_length_ratio_", exponent), [=](Random& random) {
                          HardPair pair = make(random);
                          std::swap(pair.p0, pair.q0);
                          std::swap(pair.p1, pair.q1);
                          return pair;
                        }});
  }
  for (const int exponent : {3, 6, 8}) {
    const double away = power_of_ten(exponent);
    families.push_back({numbered("millimetres_at_", exponent), [=](Random& random) {
                          const Vector3d shift = away * random.direction();
                          return shifted(scaled(generic_pair(random), 1e-3), shift);
                        }});
  }
}

void append_touches(HardFamilies& families) {
  families.push_back(changed("shared_end", [](HardPair& pair) { pair.q0 = pair.p1; }));
  families.push_back({"shared_end_folded", [](Random& random) {
                        HardPair pair = crossing_pair(random, 1e-7, 0.0);
                        pair.q0 = pair.p0;
                        return pair;
                      }});
  for (int exponent = -13; exponent <= -7; ++exponent) {
    const double gap = power_of_ten(exponent);
    families.push_back({numbered("crossing_gap_", exponent), [=](Random& random) {
                          return crossing_pair(random, random.uniform(0.1, 1.0), gap);
                        }});
  }
  families.push_back({"end_on_inside", [](Random& random) {
                        HardPair pair = generic_pair(random);
                        pair.q0 = pair.p0 + random.uniform(0.0, 1.0) * (pair.p1 - pair.p0);
                        return pair;
                      }});
  // On a coarse grid differences are exact, and ties and exact contacts are common.
  families.push_back(changed("grid", [](HardPair& pair) {
    for (Vector3d* point : {&pair.p0, &pair.p1, &pair.q0, &pair.q1}) {
      *point = (4.0 * *point).unaryExpr([](double x) {
        return static_cast<double>(static_cast<int>(x));
      });
    }
  }));
}

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

#include "src/scenes/hard_pair_makers.hpp"

#include <string>

#include "src/io/number.hpp"
#include "src/scenes/portable_math.hpp"

namespace fiber {

using Eigen::Vector3d;

HardPair generic_pair(Random& random) {
  HardPair pair;
  for (Vector3d* point : {&pair.p0, &pair.p1, &pair.q0, &pair.q1}) {
    *point = random.point_in_cube(-1.0, 1.0);
  }
  return pair;
}

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

double power_of_ten(int exponent) {
  return parse_number<double>("1e" + std::to_string(exponent)).value_or(0.0);
}

}  // namespace fiber

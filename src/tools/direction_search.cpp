#include "src/tools/direction_search.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "src/paper/bounds/direction_set.hpp"

namespace fiber {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Lines = std::vector<Vector3d>;

constexpr double pi = 3.14159265358979323846;

/// In [0, end).
int random_index(int end, Random& random) {
  return static_cast<int>(random.uniform(0.0, static_cast<double>(end)));
}

Matrix3d rotation(int order, const Vector3d& axis) {
  return Eigen::AngleAxisd(2.0 * pi / order, axis.normalized()).toRotationMatrix();
}

/// All products of the generators, the identity first.
std::vector<Matrix3d> generated_group(const std::vector<Matrix3d>& generators) {
  std::vector<Matrix3d> group = {Matrix3d::Identity()};
  for (std::size_t i = 0; i < group.size(); ++i) {
    for (const Matrix3d& generator : generators) {
      const Matrix3d product = generator * group[i];
      const bool known = std::any_of(group.begin(), group.end(), [&](const Matrix3d& element) {
        return element.isApprox(product, 1e-6);
      });
      if (!known) {
        group.push_back(product);
      }
    }
  }
  return group;
}

/// A cyclic or dihedral group, or the rotations of the tetrahedron, octahedron or icosahedron.
std::vector<Matrix3d> random_group(Random& random) {
  constexpr int largest_order = 12;
  const Vector3d diagonal(1, 1, 1);
  switch (random_index(6, random)) {
    case 0:
      return generated_group({rotation(2, Vector3d::UnitZ()), rotation(3, diagonal)});
    case 1:
      return generated_group({rotation(4, Vector3d::UnitZ()), rotation(3, diagonal)});
    case 2: {
      const Vector3d vertex(0.0, 1.0, 0.5 * (1.0 + std::sqrt(5.0)));
      return generated_group({rotation(5, vertex), rotation(3, diagonal)});
    }
    case 3: {
      const int order = 2 + random_index(largest_order - 1, random);
      return generated_group({rotation(order, Vector3d::UnitZ()), rotation(2, Vector3d::UnitX())});
    }
    default:
      return generated_group(
          {rotation(2 + random_index(largest_order - 1, random), Vector3d::UnitZ())});
  }
}

/// A line whose orbit is short, for a rotation fixes it, or one in general position.
Vector3d random_seed(const std::vector<Matrix3d>& group, Random& random) {
  Vector3d direction = random.direction();
  const int element = random_index(static_cast<int>(group.size()), random);
  if (element == 0 || random.uniform(0.0, 1.0) < 0.4) {
    return direction;
  }
  const Eigen::AngleAxisd turn(group[element]);
  const bool half_turn = std::abs(turn.angle() - pi) < 1e-6;
  if (half_turn && random.uniform(0.0, 1.0) < 0.5) {
    return direction.cross(turn.axis()).normalized();  // it keeps the lines across its axis, too
  }
  return turn.axis();
}

bool contains(const Lines& lines, const Vector3d& line) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const Vector3d& other) { return std::abs(other.dot(line)) > 1.0 - 1e-6; });
}

/// Unit vectors along independent random lines, uniform over the sphere.
Lines random_lines(int count, Random& random) {
  Lines lines;
  for (int i = 0; i < count; ++i) {
    lines.push_back(random.direction());
  }
  return lines;
}

/// Lines which a random finite group of rotations maps onto each other: orbits of random size as
/// far as they fit, independent lines for the rest. Many of the best packings are of this kind, and
/// few random starts lead there.
Lines symmetric_lines(int count, Random& random) {
  constexpr int most_orbits = 100;
  const std::vector<Matrix3d> group = random_group(random);
  const auto wanted = static_cast<std::size_t>(count);
  Lines lines;
  for (int i = 0; i < most_orbits && lines.size() < wanted; ++i) {
    const Vector3d seed = random_seed(group, random);
    if (contains(lines, seed)) {
      continue;
    }
    Lines orbit;
    for (const Matrix3d& element : group) {
      const Vector3d image = element * seed;
      if (!contains(orbit, image)) {
        orbit.push_back(image);
      }
    }
    if (lines.size() + orbit.size() <= wanted) {
      lines.insert(lines.end(), orbit.begin(), orbit.end());
    }
  }
  const Lines rest = random_lines(count - static_cast<int>(lines.size()), random);
  lines.insert(lines.end(), rest.begin(), rest.end());
  return lines;
}

/// A packing with a few of its lines, next to one another, put somewhere else.
Lines disturbed_lines(Lines lines, Random& random) {
  const Vector3d centre = random.direction();
  std::sort(lines.begin(), lines.end(), [&](const Vector3d& a, const Vector3d& b) {
    return std::abs(a.dot(centre)) > std::abs(b.dot(centre));
  });
  const int most = 1 + static_cast<int>(lines.size()) / 8;
  const int moved = 1 + random_index(most, random);
  for (int i = 0; i < moved; ++i) {
    lines[i] = random.direction();
  }
  return lines;
}

constexpr double least_gain = 1e-10;  // [rad] above rounding, below what anyone can measure

/// Between the bounds, every power of ten equally likely.
double random_smoothness(double lower, double upper, Random& random) {
  return std::pow(10.0, random.uniform(std::log10(lower), std::log10(upper)));
}

Lines turned(const Matrix3d& rotation, const Lines& lines) {
  Lines result;
  for (const Vector3d& line : lines) {
    result.push_back((rotation * line).normalized());
  }
  return result;
}

Matrix3d random_rotation(Random& random) {
  Matrix3d rotation;
  rotation.col(0) = random.direction();
  rotation.col(1) = rotation.col(0).cross(random.direction()).normalized();
  rotation.col(2) = rotation.col(0).cross(rotation.col(1));
  return rotation;
}

/// The largest cosine between a line and a coordinate axis.
double nearness_to_axes(const Lines& lines) {
  double nearness = 0.0;
  for (const Vector3d& line : lines) {
    nearness = std::max(nearness, line.lpNorm<Eigen::Infinity>());
  }
  return nearness;
}

Lines farthest_first(Lines lines) {
  std::vector<double> nearness(lines.size(), 0.0);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    for (std::size_t j = i; j < lines.size(); ++j) {
      nearness[j] = std::max(nearness[j], std::abs(lines[j].dot(lines[i - 1])));
    }
    const auto farthest = std::min_element(nearness.begin() + i, nearness.end()) - nearness.begin();
    std::swap(lines[i], lines[farthest]);
    std::swap(nearness[i], nearness[farthest]);
  }
  return lines;
}

}  // namespace

double in_degrees(double radians) { return radians * (180.0 / pi); }

Lines search_directions(int count, const Lines& known, int starts, Random& random) {
  Lines best = known.empty() ? random_lines(count, random) : known;
  double best_angle = smallest_angle(best);
  for (int i = 0; i < starts; ++i) {
    Lines start;
    double smoothness = 0.0;
    switch (i % 3) {
      case 0:
        start = random_lines(count, random);
        smoothness = random_smoothness(1e-3, 3.0, random);
        break;
      case 1:
        start = symmetric_lines(count, random);
        smoothness = random_smoothness(1e-3, 3.0, random);
        break;
      default:
        start = disturbed_lines(best, random);
        smoothness = random_smoothness(1e-4, 0.3, random);
    }
    const Lines found = pack_lines(std::move(start), smoothness, best_angle);
    const double angle = smallest_angle(found);
    if (angle > best_angle + least_gain) {
      best = found;
      best_angle = angle;
    }
  }
  return best;
}

Lines better_of_fewer(const Lines& lines, const Lines& one_more) {
  constexpr double smoothness = 1e-4;
  Lines best = lines;
  double best_angle = smallest_angle(lines);
  if (smallest_angle(one_more) <= best_angle + least_gain) {
    return best;
  }
  for (std::size_t i = 0; i < one_more.size(); ++i) {
    Lines fewer = one_more;
    fewer.erase(fewer.begin() + static_cast<std::ptrdiff_t>(i));
    const Lines packed = pack_lines(fewer, smoothness, best_angle);
    for (const Lines& candidate : {fewer, packed}) {
      const double angle = smallest_angle(candidate);
      if (angle > best_angle + least_gain) {
        best = candidate;
        best_angle = angle;
      }
    }
  }
  return best;
}

Lines arranged_directions(const Lines& lines, Random& random) {
  constexpr int rotations = 1000;
  Lines best = turned(random_rotation(random), lines);
  for (int i = 1; i < rotations; ++i) {
    Lines candidate = turned(random_rotation(random), lines);
    if (nearness_to_axes(candidate) < nearness_to_axes(best)) {
      best = std::move(candidate);
    }
  }
  for (Vector3d& line : best) {
    line = line.z() < 0.0 ? Vector3d(-line) : line;
  }
  return farthest_first(std::move(best));
}

}  // namespace fiber

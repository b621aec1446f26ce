#include "src/tools/packing_starts.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace fiber {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

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

bool contains(const std::vector<Vector3d>& lines, const Vector3d& line) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const Vector3d& other) { return std::abs(other.dot(line)) > 1.0 - 1e-6; });
}

}  // namespace

std::vector<Vector3d> random_lines(int count, Random& random) {
  std::vector<Vector3d> lines;
  for (int i = 0; i < count; ++i) {
    lines.push_back(random.direction());
  }
  return lines;
}

std::vector<Vector3d> symmetric_lines(int count, Random& random) {
  constexpr int most_orbits = 100;
  const std::vector<Matrix3d> group = random_group(random);
  const auto wanted = static_cast<std::size_t>(count);
  std::vector<Vector3d> lines;
  for (int i = 0; i < most_orbits && lines.size() < wanted; ++i) {
    const Vector3d seed = random_seed(group, random);
    if (contains(lines, seed)) {
      continue;
    }
    std::vector<Vector3d> orbit;
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
  const std::vector<Vector3d> rest = random_lines(count - static_cast<int>(lines.size()), random);
  lines.insert(lines.end(), rest.begin(), rest.end());
  return lines;
}

std::vector<Vector3d> disturbed_lines(std::vector<Vector3d> lines, Random& random) {
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

}  // namespace fiber

#include "src/tools/direction_search.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "src/paper/bounds/direction_set.hpp"
#include "src/tools/line_packing.hpp"
#include "src/tools/packing_starts.hpp"

namespace fiber {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Lines = std::vector<Vector3d>;

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

double in_degrees(double radians) { return radians * (180.0 / 3.14159265358979323846); }

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

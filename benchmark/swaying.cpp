#include "benchmark/swaying.hpp"

#include <algorithm>
#include <cmath>

#include "src/scenes/portable_math.hpp"

namespace fiber {
namespace {

constexpr double frames_per_turn = 240.0;

/// [turns] by which the phases of a wave go up and down, once across the scene.
constexpr double phase_amplitude = 0.125;
constexpr int wave_count = 2;

/// [turns] by which a fibre is ahead or behind, at most.
constexpr double fiber_phase = 0.02;

/// [m] Diagonal of the box around the points; 1 if that is a point.
double size_of(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d lower = points.front();
  Eigen::Vector3d upper = points.front();
  for (const Eigen::Vector3d& point : points) {
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
  const double size = (upper - lower).norm();
  return size > 0.0 ? size : 1.0;
}

std::vector<double> smooth_phases(const FiberAssembly& fibers, Random& random) {
  const std::vector<Eigen::Vector3d>& points = fibers.points();
  const double size = points.empty() ? 1.0 : size_of(points);
  std::vector<double> phases(points.size(), 0.0);
  for (int wave = 0; wave < wave_count; ++wave) {
    const Eigen::Vector3d direction = random.direction() / size;
    const double shift = random.uniform(0.0, 1.0);
    for (std::size_t i = 0; i < points.size(); ++i) {
      phases[i] += phase_amplitude * sine_of_turns(dot(direction, points[i]) + shift);
    }
  }
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const double ahead = random.uniform(-fiber_phase, fiber_phase);
    for (std::uint32_t i = fibers.offsets()[fiber]; i < fibers.offsets()[fiber + 1]; ++i) {
      phases[i] += ahead;
    }
  }
  return phases;
}

/// By point: 1 where its fibre is one of those that move, 0 elsewhere.
std::vector<double> speeds(const FiberAssembly& fibers, double moving) {
  std::vector<double> speeds(fibers.point_count(), 0.0);
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const auto index = static_cast<double>(fiber);
    if (std::floor((index + 1.0) * moving) > std::floor(index * moving)) {
      std::fill(speeds.begin() + fibers.offsets()[fiber],
                speeds.begin() + fibers.offsets()[fiber + 1], 1.0);
    }
  }
  return speeds;
}

}  // namespace

Swaying::Swaying(const FiberAssembly& fibers, double step, std::uint64_t seed, double moving)
    : centers_(fibers.points()), speeds_(speeds(fibers, moving)), points_(fibers.points()) {
  Random random(seed);
  phases_ = smooth_phases(fibers, random);
  // A step is the chord of its part of a turn.
  const double radius = step / (2.0 * sine_of_turns(0.5 / frames_per_turn));
  const Eigen::Vector3d axis = random.direction();
  first_axis_ = radius * axis;
  second_axis_ = radius * perpendicular_unit(random.direction(), axis);
}

const std::vector<Eigen::Vector3d>& Swaying::points(std::uint32_t frame) {
  const double turned = frame / frames_per_turn;
  for (std::size_t i = 0; i < centers_.size(); ++i) {
    const double phase = phases_[i] + speeds_[i] * turned;
    points_[i] =
        centers_[i] + cosine_of_turns(phase) * first_axis_ + sine_of_turns(phase) * second_axis_;
  }
  return points_;
}

double mean_segment_length(const FiberAssembly& fibers) {
  if (fibers.segment_count() == 0) {
    return 0.0;
  }
  double sum = 0.0;
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::uint32_t i = fibers.offsets()[fiber]; i + 1 < fibers.offsets()[fiber + 1]; ++i) {
      sum += (fibers.points()[i + 1] - fibers.points()[i]).norm();
    }
  }
  return sum / static_cast<double>(fibers.segment_count());
}

}  // namespace fiber

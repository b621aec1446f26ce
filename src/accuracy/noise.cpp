#include "src/accuracy/noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "src/accuracy/statistics.hpp"

namespace fiber {
namespace {

/// Weights of a difference of frames in a row.
struct Difference {
  std::vector<double> weights;
  double variance;  // of unit noise: the sum of the squared weights
};

const std::array<Difference, 3>& differences() {
  static const std::array<Difference, 3> all{
      {{{1, -2, 1}, 6}, {{-1, 3, -3, 1}, 20}, {{1, -4, 6, -4, 1}, 70}}};
  return all;
}

/// Noise of fewer numbers than this would be a guess.
constexpr std::size_t min_samples = 30;

/// More numbers than this do not make the estimate any better.
constexpr std::size_t max_samples = 2'000'000;

/// The median of the magnitude of a normal variable is this part of its standard deviation.
constexpr double median_of_normal = 0.6744897501960817;

bool has_same_points(const FiberFrame& x, const FiberFrame& y) {
  return x.fibers.offsets() == y.fibers.offsets() && x.names == y.names;
}

/// Whether so many frames from the first one are in a row.
bool are_in_a_row(const std::vector<FiberFrame>& frames, std::size_t first, std::size_t count) {
  if (first + count > frames.size()) {
    return false;
  }
  const std::int64_t step = frames[first + 1].frame - frames[first].frame;
  for (std::size_t i = first; i + 1 < first + count; ++i) {
    if (frames[i + 1].frame - frames[i].frame != step ||
        !has_same_points(frames[i], frames[i + 1])) {
      return false;
    }
  }
  return true;
}

/// [m] The standard deviation of a coordinate by one kind of difference; none of too few numbers.
std::optional<double> noise_by(const Difference& difference,
                               const std::vector<FiberFrame>& frames) {
  const std::size_t order = difference.weights.size();
  const std::size_t points = frames.empty() ? 0 : frames.front().fibers.point_count();
  const std::size_t stride = 1 + 3 * points * frames.size() / max_samples;
  std::vector<double> magnitudes;
  for (std::size_t first = 0; first + order <= frames.size(); ++first) {
    if (!are_in_a_row(frames, first, order)) {
      continue;
    }
    for (std::size_t point = first % stride; point < frames[first].fibers.point_count();
         point += stride) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (std::size_t k = 0; k < order; ++k) {
        sum += difference.weights[k] * frames[first + k].fibers.points()[point];
      }
      for (const double coordinate : sum) {
        magnitudes.push_back(std::abs(coordinate));
      }
    }
  }
  if (magnitudes.size() < min_samples) {
    return std::nullopt;
  }
  return median(magnitudes) / (median_of_normal * std::sqrt(difference.variance));
}

double typical_step(const std::vector<FiberFrame>& frames) {
  std::vector<double> steps;
  for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
    if (!are_in_a_row(frames, i, 2)) {
      continue;
    }
    double step = 0.0;
    for (std::size_t point = 0; point < frames[i].fibers.point_count(); ++point) {
      step = std::max(
          step, (frames[i + 1].fibers.points()[point] - frames[i].fibers.points()[point]).norm());
    }
    steps.push_back(step);
  }
  return steps.empty() ? 0.0 : median(steps);
}

}  // namespace

TrackNoise estimate_noise(const std::vector<FiberFrame>& frames) {
  TrackNoise track;
  track.step = typical_step(frames);
  for (const Difference& difference : differences()) {
    const std::optional<double> noise = noise_by(difference, frames);
    if (noise && (!track.noise || *noise < *track.noise)) {
      track.noise = noise;
    }
  }
  if (!track.noise) {
    track.reason = frames.size() < 3 ? "there are fewer than three frames"
                                     : "too few frames in a row have the same points";
  }
  return track;
}

}  // namespace fiber

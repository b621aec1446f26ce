#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/scenes/portable_math.hpp"
#include "src/scenes/scenes.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

constexpr double frame_rate = 30.0;  // [Hz]

/// A point that the cable passes through: where it rests, how far it sways, and when [m, rad].
struct Knot {
  Vector3d rest;
  Vector3d sway;
  double phase;

  Vector3d at(double angle) const { return rest + std::sin(angle + phase) * sway; }
};

struct Cable {
  double radius;  // [m]
  std::uint32_t segments;
  int cycles;  // sways per period; whole, so that the scene repeats
  std::vector<Knot> knots;
};

double angle_at(double time, int cycles) { return tau * cycles * time / cables_period; }

const Cable& trunk() {
  static const Cable cable{0.010,
                           40,
                           2,
                           {{{-0.56, -0.12, 0.200}, {0.000, 0.000, 0.000}, 0.0},
                            {{-0.36, -0.03, 0.130}, {0.000, 0.010, 0.004}, 0.4},
                            {{-0.12, 0.06, 0.090}, {0.000, 0.020, 0.000}, 0.8},
                            {{0.12, 0.05, 0.090}, {0.000, 0.020, 0.004}, 1.2},
                            {{0.36, -0.05, 0.130}, {0.000, 0.010, 0.004}, 1.6},
                            {{0.56, -0.02, 0.200}, {0.000, 0.000, 0.000}, 2.0}}};
  return cable;
}

/// The cables that follow knots. Where two of them meet, one knot of each is at the crossing, their
/// heights apart by the sum of the radii and a gap that the sway opens and closes.
const std::vector<Cable>& knotted_cables() {
  static const std::vector<Cable> all{
      trunk(),
      // Draped across the trunk near x = −0.12.
      {0.007,
       60,
       3,
       {{{-0.34, -0.42, 0.007}, {0.000, 0.000, 0.000}, 0.0},
        {{-0.27, -0.27, 0.012}, {0.010, 0.000, 0.000}, 0.0},
        {{-0.18, -0.10, 0.070}, {0.008, 0.000, 0.010}, 0.3},
        {{-0.12, 0.06, 0.115}, {0.000, 0.000, 0.007}, 0.3},
        {{-0.06, 0.24, 0.039}, {0.004, 0.000, 0.008}, 0.3},
        {{0.04, 0.37, 0.007}, {0.020, 0.000, 0.000}, 0.8},
        {{0.20, 0.43, 0.007}, {0.000, 0.000, 0.000}, 0.0}}},
      // Meanders on the ground, under the draped cable and under the trunk.
      {0.005,
       80,
       2,
       {{{-0.58, 0.10, 0.005}, {0.000, 0.000, 0.000}, 0.0},
        {{-0.42, 0.26, 0.005}, {0.010, 0.020, 0.000}, 0.0},
        {{-0.22, 0.20, 0.005}, {0.010, 0.030, 0.000}, 0.9},
        {{-0.06, 0.24, 0.014}, {0.004, 0.006, 0.009}, 1.8},
        {{0.14, 0.20, 0.005}, {0.010, 0.030, 0.000}, 2.7},
        {{0.30, 0.28, 0.005}, {0.010, 0.020, 0.000}, 3.6},
        {{0.42, 0.12, 0.005}, {0.020, 0.010, 0.000}, 4.5},
        {{0.40, -0.12, 0.005}, {0.020, 0.010, 0.000}, 5.4},
        {{0.56, -0.22, 0.005}, {0.000, 0.000, 0.000}, 0.0}}},
      // A loop: out along the ground, around, and back across itself.
      {0.006,
       70,
       4,
       {{{-0.52, -0.30, 0.006}, {0.000, 0.000, 0.000}, 0.0},
        {{-0.27, -0.31, 0.028}, {0.000, 0.010, 0.000}, 0.0},
        {{-0.04, -0.28, 0.006}, {0.000, 0.000, 0.000}, 0.0},
        {{0.16, -0.25, 0.010}, {0.015, 0.000, 0.000}, 0.5},
        {{0.22, -0.12, 0.020}, {0.010, 0.010, 0.000}, 0.8},
        {{0.10, -0.05, 0.030}, {0.000, 0.012, 0.000}, 1.1},
        {{-0.02, -0.13, 0.030}, {0.012, 0.000, 0.006}, 1.4},
        {{-0.04, -0.28, 0.022}, {0.000, 0.000, 0.006}, 1.7},
        {{0.05, -0.40, 0.006}, {0.000, 0.000, 0.000}, 0.0},
        {{0.24, -0.42, 0.006}, {0.010, 0.010, 0.000}, 2.0},
        {{0.46, -0.36, 0.006}, {0.000, 0.000, 0.000}, 0.0}}},
  };
  return all;
}

/// The curve through the knots at u from 0 to 1: a uniform Catmull–Rom spline, whose ends have a
/// knot mirrored beyond them.
Vector3d along(const Cable& cable, double time, double u) {
  const double angle = angle_at(time, cable.cycles);
  const auto last = static_cast<int>(cable.knots.size()) - 1;
  const int span = std::min(static_cast<int>(u * last), last - 1);
  const auto knot = [&](int i) { return cable.knots[static_cast<std::size_t>(i)].at(angle); };
  const Vector3d b = knot(span);
  const Vector3d c = knot(span + 1);
  const Vector3d a = span > 0 ? knot(span - 1) : Vector3d(2.0 * b - c);
  const Vector3d d = span + 2 <= last ? knot(span + 2) : Vector3d(2.0 * c - b);
  const double x = u * last - span;
  Vector3d point =
      b +
      0.5 * x * ((c - a) + x * ((2.0 * a - 5.0 * b + 4.0 * c - d) + x * (3.0 * (b - c) + d - a)));
  point.z() = std::max(point.z(), cable.radius);  // between knots the spline dips into the ground
  return point;
}

constexpr double vine_radius = 0.004;  // [m]
constexpr std::uint32_t vine_segments = 80;

/// The thin cable around the trunk: a helix whose distance swells and shrinks in a wave that runs
/// along it, and that leaves the trunk at both ends.
Vector3d along_vine(double time, double u) {
  constexpr double first = 0.46;
  constexpr double last = 0.96;
  constexpr double turns = 3.5;
  const double v = first + (last - first) * u;
  const Vector3d center = along(trunk(), time, v);
  const Vector3d tangent =
      (along(trunk(), time, v + 0.005) - along(trunk(), time, v - 0.005)).normalized();
  const Vector3d side = tangent.cross(Vector3d::UnitZ()).normalized();
  const Vector3d up = side.cross(tangent);
  const double wave = std::sin(angle_at(time, 3) - tau * 1.5 * u);
  const double flare = std::pow(2.0 * u - 1.0, 6);
  const double distance = trunk().radius + vine_radius + 0.013 + 0.0145 * wave + 0.040 * flare;
  const double turn = tau * turns * u + 0.5 * std::sin(angle_at(time, 1));
  return center + distance * (std::cos(turn) * side + std::sin(turn) * up);
}

}  // namespace

FiberAssembly cables(double time) {
  std::vector<Vector3d> points;
  std::vector<std::uint32_t> offsets{0};
  std::vector<double> radii;
  const auto add = [&](double radius, std::uint32_t segments, const auto& curve) {
    for (std::uint32_t i = 0; i <= segments; ++i) {
      points.push_back(curve(static_cast<double>(i) / segments));
    }
    offsets.push_back(static_cast<std::uint32_t>(points.size()));
    radii.push_back(radius);
  };
  for (const Cable& cable : knotted_cables()) {
    add(cable.radius, cable.segments, [&](double u) { return along(cable, time, u); });
  }
  add(vine_radius, vine_segments, [time](double u) { return along_vine(time, u); });
  return {std::move(points), std::move(offsets), std::move(radii)};
}

FiberAssembly cables(const SceneOptions& options, std::uint32_t frame) {
  const FiberAssembly all = cables(frame / frame_rate);
  const auto count = static_cast<std::uint32_t>(all.fiber_count());
  // No cable has more points than all of them.
  const auto points = static_cast<std::uint32_t>(all.point_count());
  std::vector<std::uint32_t> first(scaled_fiber_count(options, count, points, count));
  std::iota(first.begin(), first.end(), 0U);
  return select_fibers(all, first);
}

}  // namespace fiber

#include "src/scenes/scalp.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fiber {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double cell_area = 1.0 / hair_density;  // [m²]
constexpr double jitter = 0.35;                   // of a cell's width, to either side

/// Direction of the crown: behind the top, so that the patch leaves the face free.
const Vector3d crown = unit({-0.5, 0.0, 1.0});
const Vector3d crown_front = perpendicular_unit({1.0, 0.0, 0.0}, crown);
const Vector3d crown_left = crown.cross(crown_front);

/// On the unit sphere, by the angle to the crown and the one around it [turns].
Vector3d sphere_point(double polar, double azimuth) {
  return cosine_of_turns(polar) * crown +
         sine_of_turns(polar) *
             (cosine_of_turns(azimuth) * crown_front + sine_of_turns(azimuth) * crown_left);
}

/// Area on the head per area on the unit sphere [m²].
double stretch(const Vector3d& on_sphere) {
  const Vector3d scaled = Head::to_sphere(on_sphere);
  return Head::semi_axes[0] * Head::semi_axes[1] * Head::semi_axes[2] *
         std::sqrt(dot(scaled, scaled));
}

Root scalp_root(double polar, double azimuth) {
  const Vector3d point = Head::from_sphere(sphere_point(polar, azimuth));
  const double distance = 2.0 * sine_of_turns(0.5 * polar) * Head::semi_axes[0];
  return {point, Head::normal(point),
          distance * Vector2d(cosine_of_turns(azimuth), sine_of_turns(azimuth)), polar};
}

constexpr unsigned grid_levels = 16;  // of the Hilbert curve: 2^16 cells a side
constexpr unsigned lock_levels = 3;   // of these within a lock

/// How far along the Hilbert curve through the grid a cell comes.
std::uint32_t hilbert_index(std::uint32_t x, std::uint32_t y) {
  constexpr std::uint32_t last = (1U << grid_levels) - 1;
  std::uint32_t index = 0;
  for (unsigned level = grid_levels; level-- > 0;) {
    const std::uint32_t right = (x >> level) & 1U;
    const std::uint32_t up = (y >> level) & 1U;
    index = (index << 2U) | ((3U * right) ^ up);
    // The curve enters and leaves each quadrant in its own orientation.
    if (up == 0) {
      if (right == 1) {
        x = last - x;
        y = last - y;
      }
      std::swap(x, y);
    }
  }
  return index;
}

std::uint32_t grid_coordinate(double position, double cell_size) {
  constexpr double middle = 1U << (grid_levels - 1);
  const double cell = std::floor(position / cell_size) + middle;
  return static_cast<std::uint32_t>(std::clamp(cell, 0.0, 2.0 * middle - 1.0));
}

}  // namespace

double Head::level(const Vector3d& point) {
  const Vector3d image = to_sphere(point);
  return std::sqrt(dot(image, image));
}

Vector3d Head::lifted(const Vector3d& point, double min_level) {
  const double current = level(point);
  return current < min_level ? Vector3d(point * (min_level / current)) : point;
}

Vector3d Head::normal(const Vector3d& point) { return unit(to_sphere(to_sphere(point))); }

std::vector<Root> scalp_roots(std::uint32_t count, Random& random) {
  // Turns of the spiral are as far apart as the roots along them.
  const double pitch = std::sqrt(cell_area) / Head::semi_axes[0] / tau;  // [turns of angle]
  std::vector<Root> roots;
  roots.reserve(count);
  double polar = 0.5 * pitch;
  double azimuth = 0.0;
  while (roots.size() < count) {
    const double circumference = tau * sine_of_turns(polar);
    const double width = tau * pitch * stretch(sphere_point(polar, azimuth));
    const double step = cell_area / (width * circumference);  // [turns]
    const double across = random.uniform(-jitter, jitter);
    const double along = random.uniform(-jitter, jitter);
    roots.push_back(scalp_root(polar + across * pitch, azimuth + along * step));
    azimuth += step;
    polar += pitch * step;
  }
  return roots;
}

std::vector<Root> disc_roots(std::uint32_t count, Random& random) {
  constexpr double golden_angle = 0.3819660112501051;  // [turns]
  const double cell_edge = std::sqrt(cell_area);
  std::vector<Root> roots;
  roots.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const double radius = std::sqrt((i + 0.5) * cell_area * 2.0 / tau);
    const double turn = golden_angle * i;
    const double dx = random.uniform(-jitter, jitter) * cell_edge;
    const double dy = random.uniform(-jitter, jitter) * cell_edge;
    const Vector2d map(radius * cosine_of_turns(turn) + dx, radius * sine_of_turns(turn) + dy);
    roots.push_back({{map.x(), map.y(), 0.0}, {0.0, 0.0, -1.0}, map, 0.0});
  }
  return roots;
}

std::vector<Lock> order_in_locks(std::vector<Root>& roots, double lock_size) {
  struct Place {
    std::uint32_t index;  // along the curve
    std::uint32_t root;
    bool operator<(const Place& other) const {
      return index != other.index ? index < other.index : root < other.root;
    }
  };
  const double cell = lock_size / (1U << lock_levels);
  std::vector<Place> places;
  places.reserve(roots.size());
  for (const Root& root : roots) {
    places.push_back(
        {hilbert_index(grid_coordinate(root.map.x(), cell), grid_coordinate(root.map.y(), cell)),
         static_cast<std::uint32_t>(places.size())});
  }
  std::sort(places.begin(), places.end());

  std::vector<Root> ordered;
  ordered.reserve(roots.size());
  std::vector<Lock> locks;
  std::uint32_t last_lock = 0;
  for (const Place& place : places) {
    const std::uint32_t lock = place.index >> (2U * lock_levels);
    if (locks.empty() || lock != last_lock) {
      locks.push_back({static_cast<std::uint32_t>(ordered.size()), 0});
      last_lock = lock;
    }
    ordered.push_back(roots[place.root]);
    locks.back().end = static_cast<std::uint32_t>(ordered.size());
  }
  roots = std::move(ordered);
  return locks;
}

}  // namespace fiber

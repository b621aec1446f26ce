#include "benchmark/environment/capsule_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "src/scenes/portable_math.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

/// Distance from the z axis and height [m].
struct ProfilePoint {
  double around;
  double height;
};

/// The outline of the capsule from its lower end, by length along it [m].
ProfilePoint profile(double radius, double length, double along) {
  constexpr double tau = 6.283185307179586;
  const double cap = tau / 4.0 * radius;
  const double side = std::clamp(along - cap, 0.0, length);
  const double turns = (along - side) / (tau * radius) - 0.25;  // of latitude
  return {radius * cosine_of_turns(turns), side - length / 2.0 + radius * sine_of_turns(turns)};
}

}  // namespace

/// Rings of vertices between two poles; as many bands between them, and one more, as vertices in
/// a ring.
std::shared_ptr<const TriangleMesh> capsule_mesh(double radius, double length,
                                                 std::uint32_t triangles) {
  const auto around = std::max(3U, static_cast<std::uint32_t>(std::sqrt(triangles / 2.0)));
  constexpr double half_turn = 3.141592653589793;
  const double outline = half_turn * radius + length;
  std::vector<Vector3d> vertices{{0.0, 0.0, -length / 2.0 - radius}};
  for (std::uint32_t ring = 0; ring < around; ++ring) {
    const ProfilePoint at = profile(radius, length, outline * (ring + 1) / (around + 1));
    for (std::uint32_t i = 0; i < around; ++i) {
      const double turn = static_cast<double>(i) / around;
      vertices.emplace_back(at.around * cosine_of_turns(turn), at.around * sine_of_turns(turn),
                            at.height);
    }
  }
  vertices.emplace_back(0.0, 0.0, length / 2.0 + radius);

  const auto vertex = [&](std::uint32_t ring, std::uint32_t i) {
    return 1 + ring * around + i % around;
  };
  const auto last = static_cast<std::uint32_t>(vertices.size() - 1);
  std::vector<TriangleMesh::Triangle> all;
  for (std::uint32_t i = 0; i < around; ++i) {
    all.push_back({0, vertex(0, i + 1), vertex(0, i)});
    for (std::uint32_t ring = 0; ring + 1 < around; ++ring) {
      all.push_back({vertex(ring, i), vertex(ring, i + 1), vertex(ring + 1, i + 1)});
      all.push_back({vertex(ring, i), vertex(ring + 1, i + 1), vertex(ring + 1, i)});
    }
    all.push_back({last, vertex(around - 1, i), vertex(around - 1, i + 1)});
  }
  return std::make_shared<const TriangleMesh>(std::move(vertices), std::move(all));
}

}  // namespace fiber

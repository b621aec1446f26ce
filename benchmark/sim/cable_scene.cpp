#include "benchmark/sim/cable_scene.hpp"

#include <cmath>

#include "benchmark/sim/hose.hpp"

namespace fiber {

using Eigen::Vector3d;

int CableScene::steps() const { return static_cast<int>(std::lround(seconds / step)); }

double CableScene::fade(double length) const { return std::exp(-fading * length); }

CableScene hanging_cable() {
  CableScene scene;
  scene.name = "hanging";
  scene.seconds = 1.0;
  scene.radius = 0.004;
  scene.material = material_preset("rope");
  scene.first_end = CableEnd::PINNED;
  scene.cables = {{Vector3d::Zero(), Vector3d(std::sqrt(0.5), 0.0, -std::sqrt(0.5))}};
  return scene;
}

CableScene cantilever_cable() {
  CableScene scene;
  scene.name = "cantilever";
  scene.seconds = 4.0;
  scene.radius = Hose::radius;
  scene.material = Hose::material();
  scene.first_end = CableEnd::CLAMPED;
  scene.fading = 6.0;  // near critical for the slowest mode
  scene.cables = {{Vector3d::Zero(), Vector3d(Hose::length, 0.0, 0.0)}};
  return scene;
}

CableScene falling_cables(int count) {
  constexpr double height = 0.2;    // [m] of the lower layer
  constexpr double between = 0.05;  // [m] layers, and neighbours in one
  CableScene scene;
  scene.name = "falling";
  scene.seconds = 2.0;
  scene.radius = 0.004;
  scene.material = material_preset("rope");
  scene.touches = true;
  scene.friction = 0.4;
  const int rows = (count + 1) / 2;
  for (int cable = 0; cable < count; ++cable) {
    const bool is_upper = cable % 2 != 0;
    const int row = cable / 2;
    const double across = between * (row - 0.5 * (rows - 1));
    const double turn = 0.01 * (cable * 7 % 5 - 2);  // hardly two are parallel
    const Vector3d along(std::cos(turn), std::sin(turn), 0.0);
    const Vector3d centre(0.0, across, is_upper ? height + between : height);
    std::array<Vector3d, 2> ends{centre - 0.5 * along, centre + 0.5 * along};
    if (is_upper) {
      for (Vector3d& end : ends) {
        end = Vector3d(-end.y(), end.x(), end.z());
      }
    }
    scene.cables.push_back(ends);
  }
  return scene;
}

}  // namespace fiber

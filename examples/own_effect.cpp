// An effect of one's own: a trap that pulls every node of a rod towards a point, as optical
// tweezers do.
#include <cstdio>
#include <fiber_proximity/sim/effect.hpp>
#include <fiber_proximity/sim/rods.hpp>
#include <fiber_proximity/sim/stepper.hpp>
#include <memory>
#include <utility>

namespace {

class Trap : public fiber::Effect {
 public:
  /// @param stiffness of the pull on each node [N/m]
  Trap(const Eigen::Vector3d& center, double stiffness) : center_(center), stiffness_(stiffness) {}

  void energy(const fiber::RodPack& rods, const std::vector<fiber::SimdBatch>& /*values*/,
              fiber::SimdBatch& energy) const override {
    energy = {};
    for (std::size_t lane = 0; lane < rods.used; ++lane) {
      for (std::uint32_t node = 0; node < rods.node_count; ++node) {
        energy[lane] += 0.5 * stiffness_ * from_center(rods, node, lane).squaredNorm();
      }
    }
  }

  void add_derivatives(const fiber::RodPack& rods, const std::vector<fiber::SimdBatch>& /*values*/,
                       fiber::PackSystem& system) const override {
    for (std::size_t lane = 0; lane < rods.used; ++lane) {
      fiber::RodSystem of_rod(system, lane);
      for (std::uint32_t node = 0; node < rods.node_count; ++node) {
        of_rod.add_gradient(node, stiffness_ * from_center(rods, node, lane));
        of_rod.add_hessian(node, stiffness_ * Eigen::Matrix3d::Identity());
      }
    }
  }

 private:
  Eigen::Vector3d from_center(const fiber::RodPack& rods, std::uint32_t node,
                              std::size_t lane) const {
    const std::size_t first = node * rods.unknowns;  // 3 of each node, with twist 4
    const Eigen::Vector3d position(rods.positions[first][lane], rods.positions[first + 1][lane],
                                   rods.positions[first + 2][lane]);
    return position - center_;
  }

  Eigen::Vector3d center_;
  double stiffness_;
};

}  // namespace

int main() {
  fiber::Rods rods;
  const fiber::RodMaterial material = fiber::material_preset("silicone_tube");
  rods.add({{0.9, 0, 0}, {1.0, 0, 0}, {1.1, 0, 0}}, 0.002,
           fiber::solid_round_section(material, 0.002));
  fiber::Effects effects;
  effects.push_back(std::make_unique<Trap>(Eigen::Vector3d(0, 0, 0.5), 0.01));
  fiber::Stepper stepper(std::move(rods), std::move(effects));
  for (int frame = 0; frame <= 5; ++frame) {
    const Eigen::Vector3d& middle = stepper.rods().positions[1];
    std::printf("%.1f s: the middle is at %.3f %.3f %.3f\n", stepper.time(), middle.x(), middle.y(),
                middle.z());
    for (int step = 0; step < 24; ++step) {
      stepper.step(1.0 / 240.0);
    }
  }
}

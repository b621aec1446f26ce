#include "benchmark/sim/own_cables.hpp"

#include <sstream>

#include "validation/sim/contact_scenes.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

class OwnCables final : public CableSimulation {
 public:
  OwnCables(const CableScene& scene, int segments, const StepperOptions& options, int substeps)
      : substeps_(substeps), fade_(scene.fade(CableScene::step / substeps)) {
    Rods rods;
    std::vector<Attachment::Hold> holds;
    for (const auto& [first, last] : scene.cables) {
      if (scene.first_end != CableEnd::FREE) {
        const Vector3d tangent = (last - first).normalized();
        holds.push_back(scene.first_end == CableEnd::PINNED
                            ? pin(0, first)
                            : clamp(0, {first, tangent, tangent.unitOrthogonal()}));
        holds.back().rod = rods.count();
      }
      rods.add(straight(first, last, segments), scene.radius, scene.section());
    }
    Effects effects = elastic(CableScene::gravity);
    if (!holds.empty()) {
      effects.push_back(hold(rods, holds));
    }
    const auto floor = environment_of(HalfSpaceShape{});
    stepper_ =
        std::make_unique<Stepper>(std::move(rods), std::move(effects), options,
                                  scene.touches ? contacts_with(floor, scene.friction) : nullptr);
  }

  void step() override {
    for (int i = 0; i < substeps_; ++i) {
      stepper_->step(CableScene::step / substeps_);
      if (fade_ < 1.0) {
        for (Vector3d& velocity : stepper_->rods().velocities) {
          velocity *= fade_;
        }
      }
    }
  }

  std::vector<Vector3d> positions() override { return stepper_->rods().positions; }

 private:
  int substeps_;
  double fade_;  // of a substep
  std::unique_ptr<Stepper> stepper_;
};

std::string words(const StepperOptions& options) {
  std::ostringstream text;
  text << (options.integrator == Integrator::BDF2 ? "BDF2" : "implicit Euler") << ", residual "
       << options.residual;
  return text.str();
}

}  // namespace

std::unique_ptr<CableSimulation> make_own_cables(const CableScene& scene, int segments,
                                                 const StepperOptions& options, int substeps) {
  return std::make_unique<OwnCables>(scene, segments, options, substeps);
}

std::vector<CableMethod> own_cables(const CableScene& scene, const std::vector<int>& segments) {
  std::vector<StepperOptions> settings(3);
  settings[1].residual = 1e-2;
  settings[2].residual = 1e-4;
  if (scene.fading == 0.0 && !scene.touches) {  // what swings
    for (std::size_t i = 0; i < 3; ++i) {
      settings.push_back(settings[i]);
      settings.back().integrator = Integrator::BDF2;
    }
  }
  std::vector<CableMethod> methods;
  for (const int count : segments) {
    for (StepperOptions options : settings) {
      options.threads = 1;
      methods.push_back({"own", words(options), count, [count, options](const CableScene& of) {
                           return make_own_cables(of, count, options);
                         }});
    }
  }
  return methods;
}

}  // namespace fiber

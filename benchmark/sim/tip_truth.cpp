#include "benchmark/sim/tip_truth.hpp"

#include <cassert>
#include <cmath>

#include "benchmark/sim/own_cables.hpp"
#include "validation/sim/elastica.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

constexpr int steps_per_frame = 4;

/// The tip of a single cable in each frame.
std::vector<Vector3d> converging_tips(const CableScene& scene, int segments, int substeps) {
  StepperOptions options;
  options.integrator = Integrator::BDF2;
  options.residual = 1e-7;  // far less than others leave
  options.threads = 1;
  const auto simulation =
      make_own_cables(scene, segments, options, std::max(1, substeps / steps_per_frame));
  std::vector<Vector3d> tips;
  for (int i = 1; i <= scene.steps(); ++i) {
    simulation->step();
    if (i % steps_per_frame == 0) {
      tips.push_back(simulation->positions().back());
    }
  }
  return tips;
}

}  // namespace

TipTruth::TipTruth(const CableScene& scene, int segments, int substeps)
    : length_(scene.length()), rests_(scene.fading > 0.0) {
  assert(scene.cables.size() == 1 && !scene.touches);
  if (scene.first_end == CableEnd::CLAMPED) {
    const RodSection section = scene.section();
    const double load = section.mass_per_length * CableScene::gravity * std::pow(length_, 3) /
                        section.bending_stiffness;
    const CantileverTip tip = cantilever_tip(0.0, load);
    tips_ = {length_ * Vector3d(tip.reach, 0.0, -tip.drop)};
    return;
  }
  tips_ = converging_tips(scene, segments, substeps);
  const std::vector<Vector3d> coarse = converging_tips(scene, segments / 2, substeps);
  const std::vector<Vector3d> slow = converging_tips(scene, segments / 2, substeps / 2);
  for (std::size_t i = 0; i < tips_.size(); ++i) {  // both of second order (Richardson)
    tips_[i] += (tips_[i] - coarse[i]) / 3.0 + (coarse[i] - slow[i]) / 3.0;
  }
}

double TipTruth::error(const CableRun& run) const {
  if (rests_) {
    return (run.positions.back().back() - tips_.back()).norm() / length_;
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < tips_.size(); ++i) {
    sum += (run.positions[(i + 1) * steps_per_frame].back() - tips_[i]).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(tips_.size())) / length_;
}

}  // namespace fiber

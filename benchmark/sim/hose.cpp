#include "benchmark/sim/hose.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "benchmark/processor_time.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// The residual of the reference, far less than the others leave.
constexpr double exact_residual = 1e-7;

std::unique_ptr<Stepper> make_hose(const HoseSetting& setting) {
  Rods rods;
  rods.add(Hose::points(setting.segments), Hose::radius, Hose::section());
  auto clamped = hold(rods, {clamp(0, {Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY()})});
  StepperOptions options;
  options.integrator = setting.integrator;
  options.residual = setting.residual;
  options.max_iterations = static_cast<std::uint32_t>(setting.max_iterations);
  options.threads = 1;
  return std::make_unique<Stepper>(
      rods,
      effects(std::make_unique<Gravity>(Vector3d(0.0, 0.0, -Hose::gravity)),
              std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(clamped)),
      options);
}

Vector3d tip_at_rest(int segments) {
  HoseSetting setting;
  setting.segments = segments;
  setting.residual = exact_residual;
  const auto stepper = make_hose(setting);
  settle(*stepper);
  return stepper->rods().positions.back();
}

}  // namespace

RodMaterial Hose::material() { return {1e8, 4e7, 1200.0}; }

RodSection Hose::section() { return solid_round_section(material(), radius); }

std::vector<Vector3d> Hose::points(int segments) {
  return straight(Vector3d::Zero(), {length, 0.0, 0.0}, segments);
}

double hose_damping(HoseMotion motion, double step) {
  constexpr double rate = 6.0;  // [1/s] near critical for the slowest mode
  return motion == HoseMotion::SETTLING ? std::exp(-rate * step) : 1.0;
}

HoseRun simulate_hose(HoseMotion motion, const HoseSetting& setting, int frames) {
  const auto stepper = make_hose(setting);
  const double step = Hose::frame / setting.substeps;
  const double damping = hose_damping(motion, step);
  HoseRun run;
  run.tips.reserve(static_cast<std::size_t>(frames));
  run.ms = processor_time_of([&] {
    for (int frame = 0; frame < frames; ++frame) {
      for (int i = 0; i < setting.substeps; ++i) {
        stepper->step(step);
        run.iterations += stepper->report().iterations;
        run.worst_residual = std::max(run.worst_residual, stepper->report().worst.residual);
        for (Vector3d& velocity : stepper->rods().velocities) {
          velocity *= damping;
        }
      }
      run.tips.push_back(stepper->rods().positions.back());
    }
  });
  run.iterations /= frames * setting.substeps;
  return run;
}

std::vector<Vector3d> hose_reference(HoseMotion motion, int frames, int segments, int substeps) {
  if (motion == HoseMotion::SETTLING) {
    const Vector3d fine = tip_at_rest(segments);
    const Vector3d tip = fine + (fine - tip_at_rest(segments / 2)) / 3.0;
    return std::vector<Vector3d>(static_cast<std::size_t>(frames), tip);
  }
  const auto tips = [&](int segment_count, int substep_count) {
    HoseSetting setting;
    setting.segments = segment_count;
    setting.substeps = substep_count;
    setting.residual = exact_residual;
    setting.integrator = Integrator::BDF2;
    return simulate_hose(motion, setting, frames).tips;
  };
  std::vector<Vector3d> fine = tips(segments, substeps);
  const std::vector<Vector3d> coarse = tips(segments / 2, substeps);
  const std::vector<Vector3d> slow = tips(segments / 2, substeps / 2);
  for (std::size_t i = 0; i < fine.size(); ++i) {
    fine[i] += (fine[i] - coarse[i]) / 3.0 + (coarse[i] - slow[i]) / 3.0;
  }
  return fine;
}

double hose_error(HoseMotion motion, const std::vector<Vector3d>& tips,
                  const std::vector<Vector3d>& reference) {
  assert(tips.size() == reference.size() && !tips.empty());
  if (motion == HoseMotion::SETTLING) {
    return (tips.back() - reference.back()).norm() / Hose::length;
  }
  double sum = 0.0;
  for (std::size_t i = 0; i < tips.size(); ++i) {
    sum += (tips[i] - reference[i]).squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(tips.size())) / Hose::length;
}

}  // namespace fiber

#include "benchmark/sim/measurements.hpp"

#include <algorithm>
#include <cmath>

#include "benchmark/processor_time.hpp"
#include "benchmark/sim/hose.hpp"
#include "benchmark/sim/validation.hpp"
#include "benchmark/sim/xpbd_rod.hpp"
#include "validation/sim/friction_scenes.hpp"
#include "validation/sim/impacts.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

const char* name_of(HoseMotion motion) {
  return motion == HoseMotion::SWINGING ? "swinging" : "settling";
}

const char* name_of(Integrator integrator) {
  return integrator == Integrator::IMPLICIT_EULER ? "implicit_euler" : "bdf2";
}

/// A motion, for how long, and how it should go.
struct HoseTask {
  HoseTask(const SimulationMeasurement& what, HoseMotion of)
      : motion(of),
        frames(static_cast<int>(of == HoseMotion::SWINGING ? what.frames : 2 * what.frames)),
        reference(hose_reference(of, frames, what.reference_segments, what.reference_substeps)) {}

  HoseMotion motion;
  int frames;
  std::vector<Vector3d> reference;
};

/// Runs a simulation until it has taken long enough to be timed; the fastest counts.
template <class Simulate>
HoseRun repeated(double min_ms, const Simulate& simulate) {
  HoseRun run = simulate();
  for (double sum = run.ms; sum < min_ms;) {
    const double ms = simulate().ms;
    run.ms = std::min(run.ms, ms);
    sum += std::max(ms, 1e-3);
  }
  return run;
}

BenchmarkRow row_of(const char* method, const char* varied, const HoseTask& task,
                    const HoseSetting& setting, const HoseRun& run) {
  const double steps = static_cast<double>(task.frames) * setting.substeps;
  const double ms_per_step = run.ms / steps;
  return {{"method", method},
          {"motion", name_of(task.motion)},
          {"varied", varied},
          {"segments", setting.segments},
          {"substeps", setting.substeps},
          {"residual", setting.residual},
          {"max_iterations", setting.max_iterations},
          {"iterations", run.iterations},
          {"worst_residual", run.worst_residual},
          {"frames", task.frames},
          {"error", hose_error(task.motion, run.tips, task.reference)},
          {"ms_per_step", ms_per_step},
          {"us_per_node_step", 1e3 * ms_per_step / (setting.segments + 1)},
          {"ms_per_second", run.ms / (task.frames * Hose::frame)}};
}

void measure_hose(const SimulationMeasurement& what, const HoseTask& task,
                  const HoseSetting& setting, const char* varied, const ReportRow& report) {
  const HoseRun run =
      repeated(what.min_ms, [&] { return simulate_hose(task.motion, setting, task.frames); });
  report(row_of(name_of(setting.integrator), varied, task, setting, run));
}

HoseRun simulate_xpbd(const HoseTask& task, const HoseSetting& setting, int inertia) {
  XpbdRod rod(Hose::points(setting.segments), Hose::section(), inertia);
  const double step = Hose::frame / setting.substeps;
  const double damping = hose_damping(task.motion, step);
  HoseRun run;
  run.iterations = 1.0;  // passes of Gauss–Seidel
  run.ms = processor_time_of([&] {
    for (int frame = 0; frame < task.frames; ++frame) {
      for (int i = 0; i < setting.substeps; ++i) {
        rod.step(step, Vector3d(0.0, 0.0, -Hose::gravity));
        rod.damp(damping);
      }
      run.tips.push_back(rod.positions().back());
    }
  });
  return run;
}

}  // namespace

void measure_validation(const SimulationMeasurement& what, const ReportRow& report) {
  for (const std::string& about : what.validations) {
    validate_simulation(about, [&](const Validation& found) {
      report({{"test", found.test},
              {"scene", found.scene},
              {"quantity", found.quantity},
              {"segments", found.segments},
              {"theory", found.theory},
              {"simulated", found.simulated},
              {"error", found.error()},
              {"allowed", found.allowed}});
    });
  }
}

void measure_convergence(const SimulationMeasurement& what, const ReportRow& report) {
  const HoseTask swinging(what, HoseMotion::SWINGING);
  for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
    HoseSetting setting;
    setting.integrator = integrator;
    for (const int segments : what.segments) {
      for (const int substeps : what.substeps) {
        setting.segments = segments;
        setting.substeps = substeps;
        measure_hose(what, swinging, setting, "grid", report);
      }
    }
  }
  const HoseTask settling(what, HoseMotion::SETTLING);
  const auto measure_line = [&](const HoseTask& task, const char* name, auto HoseSetting::*of,
                                const auto& values) {
    HoseSetting setting;
    for (const auto value : values) {
      setting.*of = value;
      measure_hose(what, task, setting, name, report);
    }
  };
  measure_line(settling, "segments", &HoseSetting::segments, what.segments);
  measure_line(settling, "substeps", &HoseSetting::substeps, what.substeps);
  for (const HoseTask* const task : {&settling, &swinging}) {
    measure_line(*task, "residual", &HoseSetting::residual, what.residuals);
    measure_line(*task, "max_iterations", &HoseSetting::max_iterations, what.max_iterations);
  }
}

void measure_contacts(const SimulationMeasurement& what, const ReportRow& report) {
  const auto row = [&](const char* scene, const char* quantity, const char* varied, int value,
                       double theory, const auto& simulate) {
    double simulated = 0.0;
    const double ms = processor_time_of([&] { simulated = simulate(); });
    report({{"scene", scene},
            {"quantity", quantity},
            {"varied", varied},
            {"value", value},
            {"theory", theory},
            {"simulated", simulated},
            {"error", simulated / theory - 1.0},
            {"ms", ms}});
  };
  constexpr double friction = 0.3;
  for (const int edges : what.contact_edges) {
    row("rope around a post, 360°", "ratio of the tensions", "edges of a turn", edges,
        std::exp(friction * 2.0 * M_PI), [&] {
          return tension_ratio({1.0, edges}, friction);
        });
  }
  for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
    for (const int substeps : what.contact_substeps) {
      Drop drop;
      drop.integrator = integrator;
      drop.restitution = 0.7;
      drop.step = Hose::frame / substeps;
      row(integrator == Integrator::BDF2 ? "rod on a table, BDF2"
                                         : "rod on a table, implicit Euler",
          "speed of rebound / of fall", "substeps", substeps, drop.restitution,
          [&] { return std::sqrt(std::max(0.0, simulated_rebound(drop)) / drop.height); });
    }
  }
}

void measure_xpbd(const SimulationMeasurement& what, const ReportRow& report) {
  for (const HoseMotion motion : {HoseMotion::SWINGING, HoseMotion::SETTLING}) {
    const HoseTask task(what, motion);
    const auto measure = [&](int segments, int inertia, int substeps) {
      HoseSetting setting;
      setting.segments = segments;
      setting.substeps = substeps;
      const HoseRun run =
          repeated(what.min_ms, [&] { return simulate_xpbd(task, setting, inertia); });
      BenchmarkRow row = row_of("xpbd", "grid", task, setting, run);
      row["inertia"] = inertia;
      report(row);
    };
    for (const int segments : what.xpbd_segments) {
      for (const int inertia : what.xpbd_inertias) {
        for (const int substeps : what.xpbd_substeps) {
          measure(segments, inertia, substeps);
        }
      }
    }
  }
}

void measure_effect_costs(const SimulationMeasurement& what, const ReportRow& report) {
  measure_effects(what.effects, [&](const EffectCost& cost) {
    report({{"added", cost.added},
            {"effects", cost.effects},
            {"cables", what.effects.cables},
            {"segments", what.effects.segments},
            {"substeps", what.effects.substeps},
            {"frames", what.effects.frames},
            {"nodes", cost.nodes},
            {"ms_per_step", cost.ms_per_step},
            {"us_per_node_step", 1e3 * cost.ms_per_step / cost.nodes},
            {"bytes", cost.bytes},
            {"bytes_per_node", static_cast<double>(cost.bytes) / cost.nodes},
            {"unknowns_per_node", cost.unknowns_per_node}});
  });
}

void measure_real_time(const SimulationMeasurement& what, const ReportRow& report) {
  measure_loads(what.loads, [&](const LoadResult& result) {
    const double nodes = static_cast<double>(result.rods) * (result.segments + 1);
    report({{"scene", result.scene},
            {"rods", result.rods},
            {"segments", result.segments},
            {"substeps", result.substeps},
            {"threads", result.threads},
            {"frames", what.loads.frames},
            {"ms_per_step", result.ms_per_step},
            {"us_per_node_step", 1e3 * result.ms_per_step / nodes},
            {"real_time_factor", result.real_time_factor}});
  });
}

}  // namespace fiber

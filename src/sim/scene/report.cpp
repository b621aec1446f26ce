#include "src/sim/scene/report.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <numeric>
#include <optional>

#include "src/sim/scene/keys.hpp"
#include "src/sim/scene/parts.hpp"
#include "src/sim/scene/reach.hpp"
#include "src/text/quote.hpp"

namespace fiber {

namespace {

constexpr std::uint32_t max_trial_frames = 20;
constexpr double longest_trial = 0.3;  // [s]

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

double thinnest(const Rods& rods) {
  const std::vector<double>& radii = rods.edge_radii.empty() ? rods.radii : rods.edge_radii;
  return *std::min_element(radii.begin(), radii.end());
}

/// Bending waves shorter than this go faster than steps [m]: those of ω h = 1, ω = k² √(EI/ρA).
double shortest_wave(const RodSection& section, double step) {
  return 2.0 * M_PI *
         std::pow(step * step * section.bending_stiffness / section.mass_per_length, 0.25);
}

void assess_steps(const SimScene& scene, SimReport& report) {
  const double step = scene.step_length();
  double longest = 0.0;
  for (const RodSection& section : scene.stepper->rods().sections) {
    longest = std::max(longest, shortest_wave(section, step));
  }
  if (scene.options.integrator == Integrator::BDF2) {
    report.facts.push_back(format("stable: BDF2 in steps of ", 1e3 * step,
                                  " ms keeps swings; bending waves below about ", 1e3 * longest,
                                  " mm are not resolved and damped"));
    return;
  }
  // ω² h / 2 is the rate at which implicit Euler damps a swing of ω.
  const double lost = 1.0 - std::exp(-0.5 * std::pow(2.0 * M_PI, 2) * step);
  report.facts.push_back(format("stable: implicit Euler in steps of ", 1e3 * step,
                                " ms; expect bending waves below about ", 1e3 * longest,
                                " mm to be damped at once, and a swing of 1 Hz to lose ",
                                100.0 * lost, " % of its height a second"));
}

void assess_grippers(const SimScene& scene, SimReport& report) {
  const double way = scene.fastest_hold * scene.step_length();
  const double radius = thinnest(scene.stepper->rods());
  if (way > radius) {
    report.warnings.push_back(
        format("a gripper moves ", 1e3 * way, " mm a step, more than the thinnest radius, ",
               1e3 * radius, " mm: nothing passes through anything, but expect jerks in contacts; ",
               std::ceil(way / radius) * scene.substeps, " substeps would be enough"));
  } else if (way > 0.0) {
    report.facts.push_back(format("grippers move up to ", 1e3 * way, " mm a step, ", way / radius,
                                  " of the thinnest radius"));
  }
}

void assess_trial(const SimScene& scene, const SimTrial& trial, SimReport& report) {
  report.facts.push_back(format("tried ", trial.steps,
                                " step(s) on a copy of the scene, which took ",
                                1e3 * trial.duration, " ms"));
  if (!trial.failure.empty()) {
    report.warnings.push_back(
        format("expect it to stop after ", trial.steps, " step(s): ", trial.failure));
    return;
  }
  const std::string within =
      format(" within ", trial.iterations, " iteration(s) in ", trial.steps, " step(s)");
  if (trial.residual > scene.options.residual) {
    report.warnings.push_back(format("forces do not balance", within,
                                     ": they would change speeds by up to ", trial.residual,
                                     " m/s a step, `residual` is ", scene.options.residual,
                                     " m/s; expect lag; more iterations or substeps mend it"));
  } else {
    report.facts.push_back(
        format("forces balance to ", scene.options.residual, " m/s a step", within));
  }
  const std::string speed = format("expected real-time factor ", trial.real_time_factor,
                                   ", by the first ", trial.steps, " step(s)");
  if (trial.real_time_factor < 1.0) {
    report.warnings.push_back(speed +
                              ": expect it to fall behind; fewer segments or substeps, or "
                              "real_time: true, mend it");
  } else {
    report.facts.push_back(speed);
  }
}

}  // namespace

SimTrial try_scene(const SimDescription& description, std::uint32_t threads) {
  const Clock::time_point begin = Clock::now();
  SimScene scene = make_sim_scene(description, threads);
  const Clock::time_point first_step = Clock::now();
  SimTrial trial;
  try {
    double taken = 0.0;
    while (trial.steps < max_trial_frames * scene.substeps && taken < longest_trial) {
      scene.stepper->step(scene.step_length());
      taken = seconds_since(first_step);
      ++trial.steps;
      const StepReport& step = scene.stepper->report();
      trial.iterations = std::max(trial.iterations, step.iterations);
      trial.residual = std::max(trial.residual, step.worst.residual);
    }
    trial.real_time_factor = trial.steps * scene.step_length() / taken;
  } catch (const std::exception& error) {
    trial.failure = error.what();
  }
  trial.duration = seconds_since(begin);
  return trial;
}

std::vector<std::string> omissions(const SimScene& scene) {
  std::vector<std::string> found = scene.material_defaults;
  if (!scene.real_time_warning.empty()) {
    found.push_back(scene.real_time_warning);
  }
  const std::size_t obstacles = scene.environment->objects().size() + scene.moving_count;
  if (obstacles > 0 && !scene.has_effect("environment_contact")) {
    found.push_back(format("fibres pass through the ", obstacles,
                           " obstacle(s): the effect environment_contact is not named"));
  }
  if (scene.fiber_names.size() > 1 && !scene.has_effect("fiber_contact")) {
    found.push_back(format("the ", scene.fiber_names.size(),
                           " fibres pass through each other: the effect fiber_contact is not "
                           "named"));
  }
  for (const SimParameter& parameter : scene.parameters.all()) {
    if (parameter.name == "damping.relaxation_time" && parameter.value.front() > 0.0 &&
        parameter.value.front() < scene.step_length()) {
      found.push_back(format(parameter.name, " is ", parameter.value.front(),
                             " s, less than a step of ", scene.step_length(),
                             " s, which does not resolve it: more substeps would"));
    }
  }
  const bool is_only_moved =
      std::all_of(scene.effect_names.begin(), scene.effect_names.end(),
                  [](const std::string& effect) { return effect == "gravity"; });
  if (!is_only_moved && !scene.has_effect("stretch") && !scene.has_effect("inextensible")) {
    found.push_back(
        "nothing resists stretch, so that edges may shrink to nothing or grow without limit: "
        "neither the effect stretch nor inextensible is named");
  }
  return found;
}

SimReport report(const SimScene& scene, const SimTrial& trial) {
  SimReport report;
  report.warnings = omissions(scene);
  if (!scene.real_time_note.empty()) {
    report.facts.push_back(scene.real_time_note);
  }
  assess_steps(scene, report);
  assess_grippers(scene, report);
  assess_trial(scene, trial, report);
  return report;
}

namespace {

/// Warns of stretched edges in scenes where an effect resists stretch, which a hold then overcomes.
void warn_of_strain(const SimScene& scene, std::vector<SimWarning>& warnings) {
  const LargestStrain largest = largest_strain(scene.stepper->rods());
  if (largest.strain <= scene.max_strain ||
      !(scene.has_effect("stretch") || scene.has_effect("inextensible"))) {
    return;
  }
  warnings.push_back({SimWarning::Kind::STRAIN,
                      format("edge ", largest.edge, " of fibre ",
                             quote(scene.fiber_names[largest.rod]), " is stretched by ",
                             percent(largest.strain), " %, more than ", 100.0 * scene.max_strain,
                             " % (max_strain): what moves it goes too far or too fast")});
}

void warn_of_lag(const SimScene& scene, std::vector<SimWarning>& warnings) {
  if (scene.attachment == nullptr) {
    return;
  }
  const std::optional<HoldLag> lag = scene.attachment->longest_lag(scene.stepper->rods());
  if (!lag) {
    return;
  }
  warnings.push_back(
      {SimWarning::Kind::LAG,
       format("what holds node ", lag->node, " of fibre ", quote(scene.fiber_names[lag->rod]),
              " pulls with ", lag->force, " N, its greatest force (max_force), and the node is ",
              lag->distance, " m behind: something keeps it, or it moves too fast")});
}

void warn_of_obstacle_lag(const SimScene& scene, std::vector<SimWarning>& warnings) {
  const ObstacleMotions* const motions = scene.motions();
  const std::optional<ObstacleLag> lag =
      motions == nullptr ? std::nullopt : motions->longest_lag(scene.stepper->time());
  if (lag) {
    warnings.push_back(
        {SimWarning::Kind::OBSTACLE,
         format("obstacle ", quote(motions->obstacles()[lag->obstacle].object.name), " is ",
                lag->distance, " m and ", lag->angle,
                " rad behind its motion: fibres between it and something else cannot give way")});
  }
}

/// Advice how a fibre comes into balance that goes far in a step: a thin one that slides over
/// something round comes along it by parts of its radius in an iteration. Empty for others.
std::string mend_of_balance(const SimScene& scene, const IslandReport& worst) {
  constexpr double usual_way = 25.0;  // radii
  const Rods& rods = scene.stepper->rods();
  const double speed = std::accumulate(
      rods.velocities.begin() + rods.first(worst.rod),
      rods.velocities.begin() + rods.end(worst.rod), 0.0,
      [](double most, const auto& velocity) { return std::max(most, velocity.norm()); });
  const double way = speed * scene.step_length() / rods.radii[worst.rod];
  const double substeps = std::ceil(way / usual_way * scene.substeps);
  if (!(way > usual_way && substeps <= static_cast<double>(max_substeps))) {
    return {};
  }
  return format("; it goes ", way, " of its radii in a step, and with `substeps: ", substeps,
                "` no more than ", usual_way);
}

void warn_of_balance(const SimScene& scene, std::vector<SimWarning>& warnings) {
  const StepReport& report = scene.frame;
  if (report.unbalanced == 0 || scene.asks_for_few_iterations()) {
    return;
  }
  const IslandReport& worst = report.worst;
  warnings.push_back(
      {SimWarning::Kind::BALANCE,
       format("forces do not balance within ", scene.options.max_iterations,
              " iterations: what is left at node ", worst.node, " of fibre ",
              quote(scene.fiber_names[worst.rod]), " would change its speed by ", worst.residual,
              " m/s a step, ", worst.residual_force, " N; `residual` is ", scene.options.residual,
              " m/s", mend_of_balance(scene, worst))});
}

}  // namespace

std::vector<SimWarning> frame_warnings(const SimScene& scene) {
  std::vector<SimWarning> warnings;
  warn_of_strain(scene, warnings);
  warn_of_lag(scene, warnings);
  warn_of_obstacle_lag(scene, warnings);
  warn_of_balance(scene, warnings);
  return warnings;
}

}  // namespace fiber

#include "fiber_proximity/ros/sim_resolution.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

#include "fiber_proximity/sim/resolution.hpp"

namespace fiber_proximity_ros {
namespace {

/// What real_time chooses from, the finest first.
constexpr std::array<double, 8> accuracies{0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2};

/// Of the time there is: the rest is for messages, and for whatever else runs.
constexpr double share_of_time = 0.5;

double read_accuracy(const YamlField& field) {
  constexpr const char* allowed = "above 0 and at most 0.5, or 50 %";
  std::string text = field.text();
  const bool is_percent = !text.empty() && text.back() == '%';
  if (is_percent) {
    text.pop_back();
  }
  std::size_t used = 0;
  double value = 0.0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    field.refuse(allowed);
  }
  used = std::min(text.size(), text.find_first_not_of(' ', used));
  value *= is_percent ? 0.01 : 1.0;
  if (used != text.size() || !(value > 0.0 && value <= 0.5)) {
    field.refuse(allowed);
  }
  return value;
}

double length_of(const SimFiber& fiber) {
  double length = 0.0;
  for (std::size_t i = 1; i < fiber.points.size(); ++i) {
    length += (fiber.points[i] - fiber.points[i - 1]).norm();
  }
  return length;
}

SimResolution choose(const YamlField& document, const SimSteps& steps, double accuracy) {
  SimResolution resolution;
  resolution.accuracy = accuracy;
  resolution.fibers = read_sim_fibers(document.get("fibers"), accuracy);
  double period = std::numeric_limits<double>::infinity();
  for (const SimFiber& fiber : resolution.fibers) {
    period = std::min(period, fiber::swing_period(fiber.section, length_of(fiber), steps.gravity));
  }
  resolution.substeps = steps.substeps ? *steps.substeps
                                       : fiber::substeps_for(accuracy, steps.options.integrator,
                                                             steps.time_step, period);
  return resolution;
}

bool is_fast(const SimResolution& resolution, const SimSteps& steps) {
  std::uint64_t nodes = 0;
  for (const SimFiber& fiber : resolution.fibers) {
    nodes += fiber.points.size();
  }
  return fiber::frame_time(nodes, resolution.substeps, steps.options.iterations,
                           steps.has_contacts) <= share_of_time * steps.time_step;
}

void require_possible(const SimResolution& resolution, const YamlField& accuracy) {
  if (resolution.substeps > most_substeps) {
    accuracy.refuse("coarser: it takes " + std::to_string(resolution.substeps) +
                    " substeps a frame, " + std::to_string(most_substeps) +
                    " are the most; implicit_midpoint takes fewer, and `substeps` in the scene are "
                    "not chosen");
  }
}

}  // namespace

SimResolution read_sim_resolution(const YamlField& document, const SimSteps& steps) {
  const auto accuracy = document.find("accuracy");
  const auto real_time = document.find("real_time");
  const bool is_real_time = real_time && real_time->flag();
  if (accuracy && is_real_time) {
    real_time->refuse("absent or false where there is an accuracy");
  }
  if (accuracy) {
    SimResolution chosen = choose(document, steps, read_accuracy(*accuracy));
    require_possible(chosen, *accuracy);
    return chosen;
  }
  if (!is_real_time) {
    SimResolution given;
    given.fibers = read_sim_fibers(document.get("fibers"), std::nullopt);
    given.substeps = steps.substeps.value_or(given.substeps);
    return given;
  }
  SimResolution chosen;
  for (const double candidate : accuracies) {
    chosen = choose(document, steps, candidate);
    chosen.substeps = std::min(chosen.substeps, static_cast<std::uint32_t>(most_substeps));
    if (is_fast(chosen, steps)) {
      break;
    }
  }
  return chosen;
}

}  // namespace fiber_proximity_ros

#include "src/sim/scene/resolution.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

#include "fiber_proximity/sim/resolution.hpp"
#include "src/sim/scene/fibers.hpp"

namespace fiber {
namespace {

constexpr std::uint32_t most_substeps = 1000;

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

std::uint32_t chosen_substeps(double accuracy, const std::vector<FiberEntry>& fibers,
                              double gravity, const SimSettings& scene) {
  double period = std::numeric_limits<double>::infinity();
  for (const FiberEntry& fiber : fibers) {
    if (fiber.length > 0.0) {  // or it is refused when it is cut
      period = std::min(period, swing_period(fiber.section, fiber.length, gravity));
    }
  }
  return substeps_for(accuracy, scene.options.integrator, scene.time_step, period);
}

bool is_fast(double accuracy, const std::vector<FiberEntry>& fibers, std::uint32_t substeps,
             const SimSettings& scene) {
  std::uint64_t nodes = 0;
  for (const FiberEntry& fiber : fibers) {
    nodes += (fiber.segments_for(accuracy) + 1) * fiber.count.value_or(1);
  }
  // Most steps take so many iterations; a scene that says how many they may take knows better.
  constexpr std::uint32_t usual_iterations = 2;
  const std::uint32_t iterations = std::min(usual_iterations, scene.options.max_iterations);
  return frame_time(nodes, substeps, iterations, scene.has_contacts) <=
         share_of_time * scene.time_step;
}

}  // namespace

void read_resolution(const YamlField& document, double gravity, SimDescription& scene) {
  const auto accuracy = document.find("accuracy");
  const auto real_time = document.find("real_time");
  const auto given = document.find("substeps");
  const bool is_real_time = real_time && real_time->flag();
  if (accuracy && is_real_time) {
    real_time->refuse("absent or false where there is an accuracy");
  }
  if (given) {
    scene.substeps = static_cast<std::uint32_t>(given->integer(1, most_substeps));
  }
  const std::vector<FiberEntry> fibers =
      read_fibers(document.get("fibers"), accuracy || is_real_time);
  const auto choose = [&](double chosen) {
    scene.accuracy = chosen;
    scene.substeps = given ? scene.substeps : chosen_substeps(chosen, fibers, gravity, scene);
  };
  if (accuracy) {
    choose(read_accuracy(*accuracy));
  } else if (is_real_time) {
    for (const double candidate : accuracies) {
      choose(candidate);
      scene.substeps = std::min(scene.substeps, most_substeps);
      if (is_fast(candidate, fibers, scene.substeps, scene)) {
        break;
      }
    }
  }
  cut(fibers, scene.accuracy, scene);
  if (scene.substeps > most_substeps) {
    accuracy->refuse("coarser: it takes " + std::to_string(scene.substeps) + " substeps a frame, " +
                     std::to_string(most_substeps) +
                     " are the most; bdf2 takes fewer, and `substeps` in the scene "
                     "are not chosen");
  }
}

}  // namespace fiber

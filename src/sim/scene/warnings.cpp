#include "src/sim/scene/warnings.hpp"

#include <optional>
#include <sstream>

#include "src/sim/reach.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

std::ostringstream with_three_digits() {
  std::ostringstream text;
  text.precision(3);
  return text;
}

/// Where something keeps edges from being stretched, and what holds a fibre does it all the same.
void warn_of_strain(const SimScene& scene, std::vector<SimWarning>& warnings) {
  const LargestStrain largest = largest_strain(scene.stepper->rods());
  if (largest.strain <= scene.max_strain ||
      !(scene.has_effect("stretch") || scene.has_effect("inextensible"))) {
    return;
  }
  std::ostringstream text = with_three_digits();
  text << "edge " << largest.edge << " of fibre " << quote(scene.fiber_names[largest.rod])
       << " is stretched by " << 100.0 * largest.strain << " %, more than "
       << 100.0 * scene.max_strain << " % (max_strain): what moves it goes too far or too fast";
  warnings.push_back({SimWarning::Kind::STRAIN, text.str()});
}

void warn_of_lag(const SimScene& scene, std::vector<SimWarning>& warnings) {
  if (scene.attachment == nullptr) {
    return;
  }
  const std::optional<HoldLag> lag = scene.attachment->longest_lag(scene.stepper->rods());
  if (!lag) {
    return;
  }
  std::ostringstream text = with_three_digits();
  text << "what holds node " << lag->node << " of fibre " << quote(scene.fiber_names[lag->rod])
       << " pulls with " << lag->force << " N, its greatest force (max_force), and the node is "
       << lag->distance << " m behind: something keeps it, or it moves too fast";
  warnings.push_back({SimWarning::Kind::LAG, text.str()});
}

void warn_of_balance(const SimScene& scene, std::vector<SimWarning>& warnings) {
  const StepReport& report = scene.stepper->report();
  if (report.unbalanced == 0 || scene.asks_for_few_iterations()) {
    return;
  }
  const IslandReport& worst = report.worst;
  std::ostringstream text = with_three_digits();
  text << "forces do not balance within " << scene.options.max_iterations
       << " iterations: what is left at node " << worst.node << " of fibre "
       << quote(scene.fiber_names[worst.rod]) << " would change its speed by " << worst.residual
       << " m/s a step, " << scene.residual_force() << " N; `residual` is "
       << scene.options.residual << " m/s";
  warnings.push_back({SimWarning::Kind::BALANCE, text.str()});
}

}  // namespace

std::vector<SimWarning> frame_warnings(const SimScene& scene) {
  std::vector<SimWarning> warnings;
  warn_of_strain(scene, warnings);
  warn_of_lag(scene, warnings);
  warn_of_balance(scene, warnings);
  return warnings;
}

}  // namespace fiber

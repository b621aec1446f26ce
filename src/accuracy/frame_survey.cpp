#include "src/accuracy/frame_survey.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "src/accuracy/frame_order.hpp"

namespace fiber {
namespace {

/// [m] The next 1, 2 or 5 of a power of ten.
double rounded_up(double length) {
  if (length <= 0.0) {
    return 0.0;
  }
  const double power = std::pow(10.0, std::floor(std::log10(length)));
  for (const double digit : {1.0, 2.0, 5.0}) {
    if (length <= digit * power) {
      return digit * power;
    }
  }
  return 10.0 * power;
}

}  // namespace

double FrameSurvey::suggested_margin() const {
  return rounded_up(std::max(closest[closest.size() / 2], largest_radius));
}

FrameSurvey survey_frames(const std::vector<FiberFrame>& frames, const QueryOptions& options,
                          const TimeBudget& budget) {
  FrameSurvey survey;
  QueryOptions closest = options;
  closest.type = QueryType::CLOSEST;
  closest.margin = std::numeric_limits<double>::infinity();
  const std::unique_ptr<ProximityEngine> engine = make_engine("run_tree");
  QueryResult result;
  for (const FrameBlock& block : spread_blocks(frames.size())) {
    for (std::size_t i = block.begin; i < block.end; ++i) {
      if (survey.frames > 0 && budget.is_used_up()) {
        break;
      }
      const FiberAssembly& fibers = frames[i].fibers;
      engine->update(fibers);
      engine->query(closest, result);
      ++survey.frames;
      survey.largest_radius = std::max(survey.largest_radius, fibers.largest_radius());
      if (const Contact* contact = result.closest()) {
        survey.closest.push_back(contact->distance);
      }
    }
  }
  std::sort(survey.closest.begin(), survey.closest.end());
  return survey;
}

}  // namespace fiber

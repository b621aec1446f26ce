#include "src/ros/outputs/marker_output.hpp"

#include <string>

namespace fiber_proximity_ros {
namespace {

MarkerOptions marker_options(const fiber_proximity::ProximityConfig& config) {
  MarkerOptions options;
  options.show_fibers = config.show_fibers;
  options.show_contacts = config.show_contacts;
  options.show_passed = config.continuous && config.show_contacts;
  options.show_nearest = config.show_nearest;
  options.show_cost = config.show_cost;
  options.show_boxes = config.show_boxes;
  options.show_crossings = config.show_crossings;
  options.show_names = config.show_names;
  options.show_legend = config.show_legend;
  options.show_objects = config.show_objects;
  options.level = static_cast<std::uint32_t>(config.box_level);
  return options;
}

}  // namespace

void MarkerOutput::publish(const DetectedScene& subject, CrossingsOutput& crossings,
                           const fiber_proximity::ProximityConfig& config,
                           const Completeness& completeness, const Answer& answer) {
  is_requested_ = false;
  last_time_ = ros::SteadyTime::now();
  InputSet& inputs = subject.scene.fibers;
  MarkerOptions options = marker_options(config);
  if (!inputs.uncertainties().empty()) {
    options.certain_margin = subject.query.margin;
  }
  // Markers of what was detected before go when there is nothing around.
  const bool is_alone = !subject.scene.environment.is_used();
  const Detection& found = subject.detector.detection();
  const Detection& around = subject.environment.detection();
  boxes_.clear();
  if (options.show_boxes) {
    subject.detector.engine().level_boxes(options.level, boxes_);
  }
  const std::string cost = options.show_cost ? answer_text(answer) : "";
  if (options.show_crossings) {
    crossings.find(inputs.fibers(), inputs.header());
  }
  has_shown_distances_ = has_shown_distances_ || !around.contacts().contacts.empty();
  std::vector<LegendLine> legend;
  if (options.show_legend) {
    // Where fibres may touch all that is around them, there are no distances to explain.
    legend = legend_lines(options, !is_alone && options.show_contacts && has_shown_distances_,
                          subject.query.margin);
  }
  passed_.forget_old();
  const CrossingDrawing crossing_drawing{crossings.crossings(), crossings.view()};
  const EnvironmentDrawing environment{subject.environment.environment().objects(),
                                       around.contacts().contacts, around.minimum()};
  const Drawing drawing{inputs.fibers(),
                        found.contacts().contacts,
                        found.minimum(),
                        boxes_,
                        cost,
                        &crossing_drawing,
                        &inputs.names(),
                        &legend,
                        &passed_.contacts(),
                        &completeness.unknown(),
                        is_alone ? nullptr : &environment};
  builder_.build(inputs.header(), drawing, options, topic_.message());
  topic_.publish();
}

}  // namespace fiber_proximity_ros

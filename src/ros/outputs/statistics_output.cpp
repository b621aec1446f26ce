#include "src/ros/outputs/statistics_output.hpp"

#include <limits>

namespace fiber_proximity_ros {
namespace {

std::uint32_t to_count(std::size_t count) { return static_cast<std::uint32_t>(count); }

}  // namespace

StatisticsOutput::StatisticsOutput(ros::NodeHandle& private_node, const Subject& about)
    : about_(about),
      publisher_(private_node.advertise<fiber_proximity::Statistics>("statistics", 1)) {}

void StatisticsOutput::add_part(const std::string& name, double seconds) {
  parts_.emplace_back(name, seconds);
}

void StatisticsOutput::publish(fiber::Kernel kernel, double time) {
  fiber_proximity::Statistics& message = message_;
  message.header = about_.inputs.header();
  message.engine = about_.engine;
  message.fibers = to_count(about_.inputs.fibers().fiber_count());
  message.points = to_count(about_.inputs.fibers().point_count());
  message.segments = to_count(about_.inputs.fibers().segment_count());
  const Detection& found = about_.detector.detection();
  message.contacts = to_count(found.contacts().contacts.size());
  message.minimum_distance = found.minimum() != nullptr ? found.minimum()->distance
                                                        : std::numeric_limits<double>::infinity();
  message.merge_time = parts_.front().second;
  message.update_time = about_.detector.update_time();
  message.detect_time = about_.detector.detect_time();
  message.total_time = parts_.front().second + time;
  message.kernel = name_of(kernel);
  message.complete = found.is_complete();
  message.limit_reached = found.is_limit_reached();
  message.minimum_lower = found.minimum_lower();
  message.minimum_upper = found.minimum_upper();
  message.contact_error = found.contact_error();
  message.node_tests = found.counts().node_tests;
  message.node_overlaps = found.counts().node_overlaps;
  message.primitive_tests = found.counts().primitive_tests;
  message.parts.clear();
  message.part_times.clear();
  for (const auto& [name, seconds] : parts_) {
    message.parts.push_back(name);
    message.part_times.push_back(seconds);
  }
  message.discrete_answers = about_.step.problem_count();
  message.discrete_reason = about_.step.problem();
  const bool is_alone = !about_.environment.is_used();
  message.objects = is_alone ? 0 : to_count(about_.environment.environment().objects().size());
  message.environment_contacts =
      is_alone ? 0 : to_count(about_.environment.detection().contacts().contacts.size());
  message.unknown_objects = about_.environment.inputs().unknown();
  message.inputs.clear();
  for (const std::unique_ptr<Input>& input : about_.inputs.inputs()) {
    message.inputs.push_back(input->statistics(ros::Time::now()));
  }
  for (const auto& input : about_.environment.inputs().statistics(ros::Time::now())) {
    message.inputs.push_back(input);
  }
  publisher_.publish(message);
}

}  // namespace fiber_proximity_ros

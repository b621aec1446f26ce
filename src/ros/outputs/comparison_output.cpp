#include "src/ros/outputs/comparison_output.hpp"

#include <ros/console.h>

#include <exception>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace fiber_proximity_ros {
namespace {

static_assert(static_cast<int>(fiber::Verdict::BOTH) == fiber_proximity::Disagreement::BOTH &&
              static_cast<int>(fiber::Verdict::OURS) == fiber_proximity::Disagreement::OURS &&
              static_cast<int>(fiber::Verdict::FCL) == fiber_proximity::Disagreement::FCL &&
              static_cast<int>(fiber::Verdict::NEITHER) == fiber_proximity::Disagreement::NEITHER);

double gap_of(const std::optional<fiber::PairClaim>& claim) {
  return claim ? claim->gap : std::numeric_limits<double>::quiet_NaN();
}

fiber_proximity::Disagreement message_of(const fiber::Disagreement& pair) {
  fiber_proximity::Disagreement message;
  message.verdict = static_cast<std::uint8_t>(pair.verdict);
  message.fiber_a = pair.a.fiber;
  message.segment_a = pair.a.segment;
  message.fiber_b = pair.b.fiber;
  message.segment_b = pair.b.segment;
  message.ours = gap_of(pair.ours);
  message.fcl = gap_of(pair.fcl);
  message.fcl_has_answer = pair.fcl_has_answer;
  message.distance = pair.gap;
  message.is_contact = pair.is_contact;
  return message;
}

fiber_proximity::FclComparison message_of(const fiber::StyleComparison& style) {
  fiber_proximity::FclComparison message;
  message.style = name_of(style.style);
  message.update_time = style.update_time;
  message.detect_time = style.detect_time;
  message.pair_tests = style.pair_tests;
  message.contacts = style.contacts;
  message.only_ours = style.only_ours;
  message.only_fcl = style.only_fcl;
  message.in_both = style.in_both;
  message.no_answer = style.no_answer;
  message.largest_difference = style.largest_difference;
  message.largest_fiber_a = style.largest_a.fiber;
  message.largest_segment_a = style.largest_a.segment;
  message.largest_fiber_b = style.largest_b.fiber;
  message.largest_segment_b = style.largest_b.segment;
  for (const fiber::Disagreement& pair : style.disagreements) {
    message.disagreements.push_back(message_of(pair));
  }
  return message;
}

}  // namespace

ComparisonOutput::ComparisonOutput(ros::NodeHandle private_node, const DetectedScene& subject,
                                   std::function<void()> before_answer)
    : subject_(subject),
      before_answer_(std::move(before_answer)),
      publisher_(private_node.advertise<fiber_proximity::Comparison>("comparison", 1)),
      server_(private_node.advertiseService("compare", &ComparisonOutput::answer, this)) {}

void ComparisonOutput::publish() {
  try {
    publisher_.publish(compare());
  } catch (const std::exception& error) {
    ROS_ERROR_STREAM_THROTTLE(1.0, "no comparison with FCL: " << error.what());
  }
}

bool ComparisonOutput::answer(fiber_proximity::CompareWithFcl::Request& /*request*/,
                              fiber_proximity::CompareWithFcl::Response& response) {
  before_answer_();
  try {
    subject_.scene.fibers.require_fresh();
    response.comparison = compare();
    response.success = true;
  } catch (const std::exception& error) {
    response = fiber_proximity::CompareWithFcl::Response();
    response.message = error.what();
  }
  return true;
}

fiber_proximity::Comparison ComparisonOutput::compare() {
  fiber_proximity::Comparison message;
  const fiber::Comparison found =
      comparer_.compare(subject_.scene.fibers.fibers(), subject_.detector.engine(), subject_.query);
  message.header = subject_.scene.fibers.header();
  message.fiber_names = subject_.scene.fibers.names();
  message.engine = subject_.detector.engine_name();
  message.kernel = name_of(subject_.query.kernel);
  message.margin = found.margin;
  message.update_time = subject_.detector.update_time();
  message.detect_time = found.detect_time;
  message.pair_tests = found.pair_tests;
  message.contacts = found.contacts;
  for (const fiber::StyleComparison& style : found.styles) {
    message.fcl.push_back(message_of(style));
  }
  message.ours_is_right = found.ours_is_right();
  return message;
}

}  // namespace fiber_proximity_ros

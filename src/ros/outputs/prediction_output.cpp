#include "src/ros/outputs/prediction_output.hpp"

#include <ros/console.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace fiber_proximity_ros {
namespace {

using fiber::MotionContact;
using fiber_proximity::PredictedContact;

/// The earliest of the contacts that are asked for.
/// @param horizon [s]
template <class IsAsked>
PredictedContact earliest_of(const fiber::MotionResult& result, double horizon,
                             const IsAsked& is_asked) {
  PredictedContact message;
  message.touching = static_cast<std::uint32_t>(
      std::count_if(result.touching.begin(), result.touching.end(), is_asked));
  message.complete = result.complete;
  message.time_upper = std::numeric_limits<double>::infinity();
  const MotionContact* const earliest = result.earliest(is_asked);
  message.expected = earliest != nullptr;
  if (earliest == nullptr) {
    message.time_lower = result.others_lower * horizon;
    return message;
  }
  message.time_lower = std::min(earliest->lower, result.others_lower) * horizon;
  message.time_upper = earliest->upper * horizon;
  message.certain = earliest->certain;
  message.fiber_a = earliest->fiber_a;
  message.segment_a = earliest->segment_a;
  message.fiber_b = earliest->fiber_b;
  message.segment_b = earliest->segment_b;
  return message;
}

}  // namespace

PredictionOutput::PredictionOutput(ros::NodeHandle& private_node, InputSet& inputs,
                                   const std::string& engine, const fiber::EngineOptions& options,
                                   const Newcomer& on_newcomer)
    : inputs_(inputs),
      publisher_(
          advertise<fiber_proximity::TimeToContact>(private_node, "time_to_contact", on_newcomer)),
      engine_(fiber::make_engine(engine, options)) {}

void PredictionOutput::configure(const PredictionOptions& options) {
  if (options.frames != options_.frames) {
    inputs_frames_.clear();
  }
  options_ = options;
}

void PredictionOutput::publish(const fiber::QueryOptions& options,
                               const EnvironmentOutput& environment, const Knowledge& knowledge) {
  take_frames();
  message_ = {};
  message_.header = inputs_.header();
  message_.fiber_names = inputs_.names();
  message_.margin = options.margin;
  message_.horizon = options_.horizon;
  message_.assumption =
      "each point keeps the velocity of the line of least squares through its places in the last "
      "messages of its input, and objects stand still";
  try {
    predict(options, environment);
  } catch (const std::invalid_argument& error) {
    message_.same_fiber = message_.different_fibers = message_.environment = PredictedContact();
    message_.problem = error.what();
    ROS_WARN_STREAM_THROTTLE(1.0, "time_to_contact: " << message_.problem);
  }
  limit_to_known(options, knowledge);
  publisher_.publish(message_);
}

/// What is unknown may come at any moment.
void PredictionOutput::limit_to_known(const fiber::QueryOptions& options,
                                      const Knowledge& knowledge) {
  using About = Knowledge::About;
  const auto limit = [&](const Completeness& known, PredictedContact& contact) {
    contact.time_lower = known.lower(contact.time_lower, 0.0);
    contact.complete = contact.complete && known.is_complete() && message_.problem.empty();
  };
  Completeness all = knowledge.completeness(About::FIBERS_AND_ENVIRONMENT);
  const Completeness of_fibers = knowledge.completeness(About::FIBERS);
  bool is_cut_off = false;
  for (const PredictedContact* contact :
       {&message_.same_fiber, &message_.different_fibers, &message_.environment}) {
    is_cut_off = is_cut_off || !contact->complete;
  }
  limit(of_fibers, message_.same_fiber);
  limit(of_fibers, message_.different_fibers);
  limit(all, message_.environment);
  if (!message_.problem.empty()) {
    all.add_cut_off("prediction: " + message_.problem);
  } else if (is_cut_off) {
    all.add_cut_off(cut_off_text("pairs that move", options));
  }
  message_.complete = all.is_complete();
  message_.unknown = all.unknown();
}

/// Of each input its newest message, if it is new.
void PredictionOutput::take_frames() {
  const std::vector<std::unique_ptr<Input>>& inputs = inputs_.inputs();
  while (inputs_frames_.size() < inputs.size()) {
    inputs_frames_.push_back({fiber::PointVelocities(options_.frames), {}, {}, {}});
  }
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const Input& input = *inputs[i];
    InputFrames& frames = inputs_frames_[i];
    if (!input.is_fresh() || input.names() != frames.names ||
        input.fibers().offsets() != frames.offsets) {
      frames.velocities.forget();
      frames.stamp.reset();
    }
    if (input.is_fresh() && frames.stamp != input.stamp()) {
      frames.stamp = input.stamp();
      frames.names = input.names();
      frames.offsets = input.fibers().offsets();
      frames.velocities.add(frames.stamp->toSec(), input.fibers().points());
    }
  }
}

/// Where the points will be at the horizon. Who has sent one message only stands still.
/// @returns false if that are all of them
bool PredictionOutput::predict_places() {
  const std::vector<std::unique_ptr<Input>>& inputs = inputs_.inputs();
  points_.clear();
  message_.frames = std::numeric_limits<std::uint32_t>::max();
  message_.frame_time = std::numeric_limits<double>::infinity();
  bool one_moves = false;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (!inputs[i]->is_fresh()) {
      continue;
    }
    const fiber::PointVelocities& frames = inputs_frames_[i].velocities;
    if (frames.frame_count() < 2) {
      message_.assumption += "; " + inputs[i]->options().topic + ", with one message, stands still";
    } else {
      one_moves = true;
      message_.frames = std::min(message_.frames, static_cast<std::uint32_t>(frames.frame_count()));
      message_.frame_time = std::min(message_.frame_time, frames.duration());
    }
    frames.find(velocities_);
    const std::vector<Eigen::Vector3d>& points = inputs[i]->fibers().points();
    for (std::size_t point = 0; point < points.size(); ++point) {
      points_.push_back(points[point] + options_.horizon * velocities_[point]);
    }
  }
  return one_moves;
}

void PredictionOutput::predict(const fiber::QueryOptions& options,
                               const EnvironmentOutput& environment) {
  if (!inputs_.is_fresh()) {
    message_.problem = "there are no fibres";
    return;
  }
  if (!predict_places()) {
    message_.frames = 1;
    message_.frame_time = 0.0;
    message_.problem = "no input has sent more than one message: there are no velocities yet";
    return;
  }
  before_ = inputs_.fibers();  // its own: the engine refers to it until the next time
  after_ = before_;
  after_.update_points(points_);
  engine_->update_motion(before_, after_);
  fiber::MotionOptions motion = fiber::motion_options(options, options_.tolerance);
  // Takes as long as for the first one, is asked once for both, and is not reported.
  motion.type = fiber::MotionType::ALL;
  motion.contact_limit = 0;
  engine_->query_motion(motion, result_);
  message_.same_fiber = earliest_of(result_, options_.horizon, [](const MotionContact& contact) {
    return contact.fiber_a == contact.fiber_b;
  });
  message_.different_fibers =
      earliest_of(result_, options_.horizon,
                  [](const MotionContact& contact) { return contact.fiber_a != contact.fiber_b; });
  if (environment.is_used()) {
    motion.type = fiber::MotionType::FIRST;
    motion.contact_limit = options.contact_limit;
    const std::shared_ptr<const fiber::Environment> around = environment.inputs().environment();
    around->query_motion(before_, after_, *around, motion,
                         environment.inputs().allowed(inputs_.names()), result_);
    message_.object_names = object_names(*around);
  } else {
    result_ = fiber::MotionResult();
    result_.others_lower = 1.0;
  }
  message_.environment =
      earliest_of(result_, options_.horizon, [](const MotionContact&) { return true; });
}

}  // namespace fiber_proximity_ros

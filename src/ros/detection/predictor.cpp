#include "src/ros/detection/predictor.hpp"

#include <ros/console.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "src/ros/detection/detector.hpp"
#include "src/ros/detection/environment_detector.hpp"
#include "src/ros/detection/uncertainty.hpp"

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

bool is_of_same_fiber(const MotionContact& contact) { return contact.fiber_a == contact.fiber_b; }
bool is_of_different_fibers(const MotionContact& contact) { return !is_of_same_fiber(contact); }
bool is_any(const MotionContact& /*contact*/) { return true; }

/// A prediction of told points with the certain margin tells by when a contact has come.
void take_certain(const PredictedContact& certain, PredictedContact& message) {
  message.certain = certain.certain;
  message.time_upper = certain.time_upper;
}

/// A prediction of told points with the possible margin tells until when no contact can be, not
/// when one is certain to be.
void keep_possible(PredictedContact& message) {
  message.certain = false;
  message.time_upper = std::numeric_limits<double>::infinity();
  if (message.touching > 0) {
    // One of these may be apart yet, and touch at any moment.
    message.time_lower = 0.0;
  }
}

}  // namespace

void Predictor::configure(const PredictionOptions& options) {
  if (options.frames != options_.frames) {
    inputs_frames_.clear();
  }
  options_ = options;
}

void Predictor::predict(const fiber::QueryOptions& options, fiber_proximity::TimeToContact& message,
                        Budget& budget) {
  if (budget.allows(Stage::PREDICTION)) {
    budget.enter(Stage::PREDICTION);
  }
  take_frames();
  scene_.environment.keep_tracks(options_.frames);
  is_cut_off_ = false;
  left_out_.clear();
  message = {};
  message.header = scene_.fibers.header();
  message.fiber_names = scene_.fibers.names();
  message.margin = options.margin;
  message.horizon = options_.horizon;
  message.assumption =
      "each point keeps the velocity of the line of least squares through its places in the last "
      "messages of its input";
  try {
    find_contacts(options, message, budget);
  } catch (const std::invalid_argument& error) {
    message.same_fiber = message.different_fibers = message.environment = PredictedContact();
    message.problem = error.what();
    ROS_WARN_STREAM_THROTTLE(1.0, "time_to_contact: " << message.problem);
  }
  limit_to_known(options, message);
}

/// Lowers the bounds to those that hold although something is unknown: it may come at any moment.
void Predictor::limit_to_known(const fiber::QueryOptions& options,
                               fiber_proximity::TimeToContact& message) {
  using About = Knowledge::About;
  const auto limit = [&](const Completeness& known, PredictedContact& contact) {
    contact.time_lower = known.lower(contact.time_lower, 0.0);
    contact.complete = contact.complete && known.is_complete() && message.problem.empty();
  };
  Completeness all = scene_.knowledge.completeness(About::FIBERS_AND_ENVIRONMENT);
  const Completeness of_fibers = scene_.knowledge.completeness(About::FIBERS);
  for (const PredictedContact* contact :
       {&message.same_fiber, &message.different_fibers, &message.environment}) {
    is_cut_off_ = is_cut_off_ || (message.problem.empty() && !contact->complete);
  }
  limit(of_fibers, message.same_fiber);
  limit(of_fibers, message.different_fibers);
  limit(all, message.environment);
  if (!message.problem.empty()) {
    all.add_cut_off("prediction: " + message.problem);
  } else if (is_cut_off_) {
    all.add_cut_off(cut_off_text("pairs that move", options));
  }
  if (!left_out_.empty()) {
    all.add_cut_off(left_out_);
    message.environment.complete = false;
  }
  message.complete = all.is_complete();
  message.unknown = all.unknown();
}

/// Takes the newest message of each input, if it is new.
void Predictor::take_frames() {
  const auto& inputs = scene_.fibers.inputs();
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

/// Finds where the points will be at the horizon. An input that has sent only one message stands
/// still.
/// @returns false if all inputs do
bool Predictor::predict_places(fiber_proximity::TimeToContact& message) {
  const auto& inputs = scene_.fibers.inputs();
  points_.clear();
  message.frames = std::numeric_limits<std::uint32_t>::max();
  message.frame_time = std::numeric_limits<double>::infinity();
  bool one_moves = false;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (!inputs[i]->is_fresh()) {
      continue;
    }
    const fiber::PointVelocities& frames = inputs_frames_[i].velocities;
    if (frames.frame_count() < 2) {
      message.assumption += "; " + inputs[i]->options().topic + ", with one message, stands still";
    } else {
      one_moves = true;
      message.frames = std::min(message.frames, static_cast<std::uint32_t>(frames.frame_count()));
      message.frame_time = std::min(message.frame_time, frames.duration());
    }
    frames.find(velocities_);
    const std::vector<Eigen::Vector3d>& points = inputs[i]->fibers().points();
    for (std::size_t point = 0; point < points.size(); ++point) {
      points_.push_back(points[point] + options_.horizon * velocities_[point]);
    }
  }
  return one_moves;
}

/// Finds how objects go on, and tells it.
/// @returns nothing where there are none
std::optional<ObjectForecast> Predictor::forecast_objects(
    fiber_proximity::TimeToContact& message) const {
  if (!scene_.environment.is_used()) {
    return std::nullopt;
  }
  ObjectForecast objects(*around_, scene_.environment.tracks(), message.header.stamp,
                         scene_.environment.pose_timeout(), options_.horizon);
  if (objects.moving > 0) {
    message.frames = std::min(message.frames, static_cast<std::uint32_t>(objects.frames));
    message.frame_time = std::min(message.frame_time, objects.frame_time);
  }
  message.assumption += "; " + objects.assumption;
  return objects;
}

void Predictor::find_contacts(const fiber::QueryOptions& options,
                              fiber_proximity::TimeToContact& message, Budget& budget) {
  if (!scene_.fibers.is_fresh()) {
    message.problem = "there are no fibres";
    return;
  }
  if (!budget.allows(Stage::PREDICTION)) {
    is_cut_off_ = true;
    message.problem = no_time_text(options);
    return;
  }
  around_ = scene_.environment.environment();
  const bool do_fibers_move = predict_places(message);
  const std::optional<ObjectForecast> objects = forecast_objects(message);
  if (!do_fibers_move && (!objects || objects->moving == 0)) {
    message.frames = 1;
    message.frame_time = 0.0;
    message.problem = "no input has sent more than one message: there are no velocities yet";
    return;
  }
  before_ = scene_.fibers.fibers();  // its own: the engine refers to it until the next time
  after_ = before_;
  // Points of a joint are extrapolated one by one, and may part.
  after_.update_points(points_, fiber::JointCheck::LEFT_OUT);
  fiber::MotionOptions motion = fiber::motion_options(options, options_.tolerance);
  find_contacts_of_fibers(motion, objects.has_value(), message, budget);
  if (objects) {
    motion.type = fiber::MotionType::FIRST;
    find_contacts_with_objects(motion, *objects, message, budget);
  } else {
    result_ = fiber::MotionResult();
    result_.others_lower = 1.0;
    message.environment = earliest_of(result_, options_.horizon, is_any);
  }
  if (!scene_.fibers.uncertainties().empty()) {
    message.assumption += "; contacts are those that the inputs' uncertainty allows";
  }
}

void Predictor::find_contacts_of_fibers(const fiber::MotionOptions& asked, bool has_objects,
                                        fiber_proximity::TimeToContact& message, Budget& budget) {
  fiber::MotionOptions motion = asked;
  // Takes as long as for the first one, is asked once for both, and is not reported.
  motion.type = fiber::MotionType::ALL;
  motion.contact_limit = 0;
  engine_->update_motion(before_, after_);
  const auto ask = [&](double margin) {
    motion.margin = margin;
    budget.ask(motion, [&](fiber::MotionOptions in_time) {
      // Half of the time is for objects.
      in_time.deadline = has_objects ? 0.5 * in_time.deadline : in_time.deadline;
      engine_->query_motion(in_time, result_);
    });
  };
  const Uncertainty uncertainty(scene_.fibers.uncertainties(), Uncertainty::Bodies::BOTH);
  const double horizon = options_.horizon;
  ask(uncertainty.possible_margin(asked.margin));
  message.same_fiber = earliest_of(result_, horizon, is_of_same_fiber);
  message.different_fibers = earliest_of(result_, horizon, is_of_different_fibers);
  if (uncertainty.is_none()) {
    return;
  }
  keep_possible(message.same_fiber);
  keep_possible(message.different_fibers);
  if (const double certain = uncertainty.certain_margin(asked.margin); certain >= 0.0) {
    ask(certain);
    take_certain(earliest_of(result_, horizon, is_of_same_fiber), message.same_fiber);
    take_certain(earliest_of(result_, horizon, is_of_different_fibers), message.different_fibers);
  }
}

void Predictor::find_contacts_with_objects(const fiber::MotionOptions& asked,
                                           const ObjectForecast& objects,
                                           fiber_proximity::TimeToContact& message,
                                           Budget& budget) {
  fiber::MotionOptions motion = asked;
  if (motion.tolerance == 0.0 && objects.moving > 0) {
    constexpr double min_tolerance = 1e-9;  // [m] where objects turn
    motion.tolerance = min_tolerance;
  }
  const double part = objects.time / options_.horizon;
  if (part < 1.0) {
    for (std::size_t i = 0; i < points_.size(); ++i) {
      points_[i] = before_.points()[i] + part * (points_[i] - before_.points()[i]);
    }
    after_.update_points(points_, fiber::JointCheck::LEFT_OUT);
  }
  const auto ask = [&](double margin) {
    motion.margin = margin;
    budget.ask(motion, [&](const fiber::MotionOptions& in_time) {
      const fiber::AllowedPairs allowed = scene_.environment.allowed(scene_.fibers.names());
      if (objects.moving > 0) {
        around_->query_motion(before_, after_, objects.displacements, in_time, allowed, result_);
      } else {
        around_->query_motion(before_, after_, *around_, in_time, allowed, result_);
      }
    });
  };
  const Uncertainty uncertainty(scene_.fibers.uncertainties(), Uncertainty::Bodies::A);
  ask(uncertainty.possible_margin(asked.margin));
  message.object_names = object_names(*around_);
  message.environment = earliest_of(result_, objects.time, is_any);
  if (!uncertainty.is_none()) {
    keep_possible(message.environment);
    if (const double certain = uncertainty.certain_margin(asked.margin); certain >= 0.0) {
      ask(certain);
      take_certain(earliest_of(result_, objects.time, is_any), message.environment);
    }
  }
  if (part < 1.0 && !message.environment.expected) {
    left_out_ = objects.limit;
  }
}

}  // namespace fiber_proximity_ros

#include "src/ros/server/answer_pipeline.hpp"

#include <ros/console.h>

#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/query/threads.hpp"

namespace fiber_proximity_ros {

using fiber_proximity::ProximityConfig;

AnswerPipeline::AnswerPipeline(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                               const ServerOptions& options, const Settings& settings,
                               ObservedScene& scene, const Newcomer& on_newcomer,
                               const std::function<void()>& before_answer)
    : settings_(settings),
      scene_(scene),
      threads_(fiber::arena_concurrency(options.engine_options.threads)),
      detector_(options.engine, options.engine_options),
      motion_(options.engine, options.engine_options, options.fibers.timing.input_timeout),
      environment_(scene),
      predictor_(scene, options.engine, options.engine_options),
      fibers_(private_node, "fibers", on_newcomer),
      contacts_(private_node, "contacts", fiber_proximity::Contact::FIBER, on_newcomer),
      environment_contacts_(private_node, "environment_contacts", fiber_proximity::Contact::OBJECT,
                            on_newcomer),
      crossings_(private_node, scene.fibers.frame(), on_newcomer),
      time_to_contact_(private_node, "time_to_contact", on_newcomer),
      markers_(private_node, options.marker_rate, on_newcomer),
      comparison_(private_node, detected(), before_answer),
      statistics_(private_node, detected(), on_newcomer),
      diagnostics_(node, private_node, detected()) {
  detector_.set_fibers(scene.fibers.fibers());  // none yet, which can be asked about, too
}

void AnswerPipeline::answer(const AnswerCause& cause) {
  const ProximityConfig& config = settings_.config();
  begin();
  if (cause.has_new_fibers) {
    const fiber::FiberAssembly& fibers = scene_.fibers.fibers();
    detector_.set_fibers(fibers, scene_.fibers.uncertainties());
    motion_.take(scene_.fibers, config.continuous);
    crossings_.forget();
  } else {
    motion_.rest();
  }
  add_part("merge", cause.time_before + scene_.fibers.take_work_time());
  if (cause.shows_fibers) {
    publish_fibers();
  }
  markers_.request();
  const bool has_statistics = statistics_.has_listeners();
  const bool wants_everything = has_statistics || markers_.has_listeners();
  const bool wants_contacts = wants_everything || contacts_.has_listeners();
  // The end of what was around is told once: the last answer, and the end of its touches.
  const bool was_around = std::exchange(is_around_, scene_.environment.is_used());
  const bool looks_around =
      (is_around_ || was_around) && (wants_everything || environment_contacts_.has_listeners());
  const auto time = [cause] { return cause.time_before + cause.stopwatch.seconds(); };
  budget_.begin(settings_.query().deadline, time, planned_stages(wants_contacts, looks_around));
  if (wants_contacts) {
    detect();
    publish_contacts();
  } else {
    contacts_.skip();
  }
  if (looks_around) {
    detect_in_environment();
  } else {
    environment_.skip();
    environment_contacts_.skip();
  }
  predict();
  if (wants_everything) {
    tell_pairs();
  }
  answer_.total_time = time();
  const Stopwatch drawing;
  // Else they are drawn by the next tick, which no message waits for.
  if (budget_.allows(Stage::DRAWING) && publish_markers_if_due()) {
    add_part("markers", drawing.seconds());
  }
  budget_.end();
  compare();
  answer_.total_time = time();
  answer_.goes_on = false;
  if (wants_contacts) {
    diagnostics_.count(answer_, detector_.detection().cut_off(settings_.query()));
  }
  if (has_statistics) {
    statistics_.publish(answer_, scene_.knowledge.completeness(Knowledge::About::FIBERS),
                        completeness_of_all());
  }
}

void AnswerPipeline::answer_about_environment() {
  if (environment_contacts_.has_listeners()) {
    is_around_ = scene_.environment.is_used();
    const Stopwatch stopwatch;
    begin();
    motion_.rest();
    budget_.begin(
        settings_.query().deadline, [stopwatch] { return stopwatch.seconds(); },
        planned_stages(false, true));
    detect_in_environment();
    budget_.end();
    if (markers_.has_listeners()) {
      tell_pairs();
    }
    answer_.total_time = stopwatch.seconds();
    answer_.goes_on = false;
  }
}

void AnswerPipeline::tick() {
  publish_markers_if_due();
  budget_.end();
  diagnostics_.update();
}

void AnswerPipeline::begin() {
  answer_.parts.clear();
  answer_.goes_on = true;
  answer_.deadline = settings_.query().deadline;
}

/// The stages that somebody waits for.
std::vector<Stage> AnswerPipeline::planned_stages(bool wants_contacts, bool looks_around) const {
  const ProximityConfig& config = settings_.config();
  const FiberStep& step = motion_.step();
  std::vector<Stage> stages;
  if (wants_contacts) {
    stages.push_back(Stage::CONTACTS);
    if (step.is_motion()) {
      stages.push_back(Stage::MOTION);
    }
    stages.push_back(Stage::OUTPUT);
  }
  if (looks_around) {
    stages.push_back(Stage::ENVIRONMENT);
    if (environment_contacts_.has_listeners() && (step.is_motion() || step.rests())) {
      stages.push_back(Stage::ENVIRONMENT_MOTION);
    }
    stages.push_back(Stage::ENVIRONMENT_OUTPUT);
  }
  if (config.prediction > 0.0 && time_to_contact_.has_listeners()) {
    stages.push_back(Stage::PREDICTION);
  }
  return stages;
}

void AnswerPipeline::add_part(const std::string& name, double seconds, bool is_complete) {
  answer_.parts.push_back({name, seconds, is_complete});
}

/// Keeps what is known of the pairs, as the parameters may be others when it is drawn.
void AnswerPipeline::tell_pairs() {
  using About = Knowledge::About;
  const auto tell = [this](const Detection& found, About about) {
    const Completeness known = scene_.knowledge.completeness(about);
    PairsAnswer pairs;
    pairs.asked = settings_.query();
    pairs.was_all_there = known.was_all_there();
    pairs.is_cut_off = !found.are_contacts_complete();
    pairs.has_failed = found.has_failed();
    pairs.limit_reached = found.contacts().limit_reached;
    pairs.contacts = found.contacts().contacts.size();
    pairs.uncertain = found.uncertain_contacts();
    pairs.contact_error = found.contact_error();
    pairs.others_lower = found.contacts().others_lower;
    if (found.minimum() != nullptr) {
      pairs.minimum = found.minimum()->distance;
    }
    pairs.minimum_lower =
        known.lower(found.minimum_lower(), -std::numeric_limits<double>::infinity());
    pairs.minimum_upper = found.minimum_upper();
    return pairs;
  };
  answer_.fibers = tell(detector_.detection(), About::FIBERS);
  answer_.objects.reset();
  if (scene_.environment.is_used()) {
    answer_.objects = tell(environment_.detection(), About::FIBERS_AND_ENVIRONMENT);
  }
}

/// These cannot say what is unknown: they are about fibres, where there are any.
void AnswerPipeline::publish_fibers() {
  if (fibers_.has_listeners()) {
    to_message(scene_.fibers.fibers(), scene_.fibers.names(), fibers_.message());
    fibers_.message().header = scene_.fibers.header();
    fibers_.publish();
  }
  if (crossings_.is_wanted()) {
    const Stopwatch stopwatch;
    crossings_.publish(scene_.fibers.fibers(), scene_.fibers.header(), scene_.fibers.names());
    add_part("crossings", stopwatch.seconds());
  }
}

/// Finds contacts and closest pair of the fibres. Where the engine cannot, the answer says so.
void AnswerPipeline::detect() {
  const bool wants_minimum = settings_.config().minimum_distance;
  const Detection& found = detector_.detection();
  budget_.enter(Stage::CONTACTS);
  try {
    detector_.detect(settings_.query(), wants_minimum, budget_);
  } catch (const std::invalid_argument& error) {
    ROS_ERROR_STREAM_THROTTLE(1.0, "engine " << detector_.engine_name() << ": " << error.what());
  }
  if (const std::string problem = found.limit_problem(settings_.query()); !problem.empty()) {
    const std::string most = scene_.fibers.topic_of_most(found.contacts().contacts);
    ROS_WARN_STREAM_THROTTLE(1.0, "fibres (engine " << detector_.engine_name() << "): " << problem
                                                    << (most.empty() ? "" : ". Most are of input ")
                                                    << most);
  }
  add_part("update", detector_.update_time(), !found.has_failed());
  add_part("contacts", found.contact_time(), found.are_contacts_complete());
  if (wants_minimum) {
    add_part("minimum", found.minimum_time(), found.is_minimum_complete());
  }
}

/// Recognises the contacts that were found, and publishes them.
void AnswerPipeline::publish_contacts() {
  const fiber::QueryOptions& query = settings_.query();
  const Detection& found = detector_.detection();
  const Stopwatch motion_time;
  const bool is_left_out = motion_.step().is_motion() && !budget_.allows(Stage::MOTION);
  const std::optional<KnownMotion> motion =
      motion_.detect(query, found.has_all_of(query), settings_.config().motion_tolerance, budget_);
  if (motion || is_left_out) {
    add_part("motion", motion_time.seconds(), motion && motion->result.complete);
  }
  budget_.enter(Stage::OUTPUT);
  const Stopwatch stopwatch;
  const BodyNames names{scene_.fibers.names(), {}};
  const ContactAnswer answer{found,
                             query,
                             motion ? &*motion : nullptr,
                             scene_.knowledge,
                             names,
                             scene_.fibers.header(),
                             scene_.fibers.fibers()};
  contacts_.track(answer);
  markers_.add_passed(contacts_.contacts());
  add_part("touches", stopwatch.seconds());
  scene_.fibers.doubt(detector_.update_time() + detector_.detect_time() + stopwatch.seconds());
  contacts_.publish(answer, settings_.config().gradients, detector_.update_time());
}

void AnswerPipeline::detect_in_environment() {
  const ProximityConfig& config = settings_.config();
  const fiber::QueryOptions& query = settings_.query();
  const bool is_tracked = environment_contacts_.has_listeners();
  // Objects may have moved where fibres have not.
  const FiberStep& fiber_step = motion_.step();
  const ContinuousStep step{fiber_step.motion(), fiber_step.time(), config.motion_tolerance,
                            fiber_step.uncertainties()};
  budget_.enter(Stage::ENVIRONMENT);
  threads_.execute([&] {
    environment_.detect(query, config.minimum_distance,
                        fiber_step.is_motion() || fiber_step.rests() ? &step : nullptr, is_tracked,
                        budget_);
  });
  budget_.enter(Stage::ENVIRONMENT_OUTPUT);
  const Detection& found = environment_.detection();
  add_part("environment_update", environment_.update_time());
  add_part("environment_contacts", found.contact_time(), found.are_contacts_complete());
  if (config.minimum_distance) {
    add_part("environment_minimum", found.minimum_time(), found.is_minimum_complete());
  }
  if (const KnownMotion* const motion = environment_.motion(); motion != nullptr) {
    add_part("environment_motion", environment_.motion_time(), motion->result.complete);
  } else if (environment_.is_motion_left_out()) {
    add_part("environment_motion", 0.0, false);
  }
  if (!is_tracked) {
    environment_contacts_.skip();
    return;
  }
  const BodyNames names{scene_.fibers.names(), object_names(environment_.environment())};
  const ContactAnswer answer{found,
                             query,
                             environment_.motion(),
                             scene_.knowledge,
                             names,
                             scene_.fibers.header(),
                             scene_.fibers.fibers()};
  environment_contacts_.track(answer);
  environment_contacts_.publish(answer, config.gradients, environment_.update_time());
}

void AnswerPipeline::predict() {
  const ProximityConfig& config = settings_.config();
  predictor_.configure({config.prediction, static_cast<std::size_t>(config.prediction_frames),
                        config.motion_tolerance});
  if (!predictor_.is_on() || !time_to_contact_.has_listeners()) {
    predictor_.skip();
    return;
  }
  const Stopwatch stopwatch;
  threads_.execute(
      [&] { predictor_.predict(settings_.query(), time_to_contact_.message(), budget_); });
  time_to_contact_.publish();
  add_part("prediction", stopwatch.seconds(), !predictor_.is_cut_off());
}

void AnswerPipeline::compare() {
  if (settings_.config().compare && comparison_.has_listeners()) {
    const Stopwatch stopwatch;
    comparison_.publish();
    add_part("comparison", stopwatch.seconds());
  }
}

/// @returns whether they were
bool AnswerPipeline::publish_markers_if_due() {
  const bool is_due = markers_.is_due();
  if (is_due) {
    budget_.enter(Stage::DRAWING);
    markers_.publish(detected(), crossings_, settings_.config(), completeness_of_all(), answer_);
  }
  return is_due;
}

/// The completeness of contacts of fibres with each other and with objects.
Completeness AnswerPipeline::completeness_of_all() const {
  Completeness of_all = scene_.knowledge.completeness(Knowledge::About::FIBERS_AND_ENVIRONMENT);
  of_all.add_cut_off(detector_.detection().cut_off(settings_.query()));
  if (scene_.environment.is_used()) {
    of_all.add_cut_off(environment_.detection().cut_off(settings_.query()));
  }
  return of_all;
}

}  // namespace fiber_proximity_ros

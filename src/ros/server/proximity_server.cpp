#include "src/ros/server/proximity_server.hpp"

#include <ros/console.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/server/query_options.hpp"
#include "src/ros/support/callback_task.hpp"
#include "src/ros/support/stopwatch.hpp"

namespace fiber_proximity_ros {
namespace {

/// [s] How often what needs no message is looked after: expired inputs, diagnostics, late markers.
constexpr double tick_interval = 0.1;

/// [s] How often a message that waits for its transform is tried again.
constexpr double retry_interval = 0.005;

}  // namespace

ProximityServer::ProximityServer(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : node_(node),
      private_node_(private_node),
      options_(read_server_options(node, private_node)),
      config_(options_.config),
      detector_(options_.engine, options_.engine_options),
      motion_engine_(fiber::make_engine(options_.engine, options_.engine_options)),
      step_(options_.timing.input_timeout),
      newcomer_([this] { has_newcomers_ = true; }),
      contacts_(private_node_, "contacts", fiber_proximity::Contact::FIBER, newcomer_),
      fibers_publisher_(advertise<fiber_proximity::FiberArray>(private_node_, "fibers", newcomer_)),
      markers_publisher_(
          advertise<visualization_msgs::MarkerArray>(private_node_, "markers", newcomer_)),
      inputs_(node_, options_.inputs, options_.left_out_inputs, options_.timing,
              options_.fixed_frame, query_options_, [this] { schedule(); }),
      crossings_(private_node_, inputs_.frame(), newcomer_),
      environment_(
          node_, private_node_, inputs_, [this] { schedule(); }, newcomer_),
      knowledge_(inputs_, environment_.inputs()),
      diagnostics_(node_, private_node_,
                   {inputs_, environment_.inputs(), knowledge_, detector_, query_options_}),
      statistics_(private_node_, {options_.engine, inputs_, detector_, environment_, step_},
                  newcomer_),
      prediction_(private_node_, inputs_, options_.engine, options_.engine_options, newcomer_),
      comparison_(private_node_, {inputs_, detector_, query_options_, options_.engine},
                  [this] { process(); }),
      queries_(serve_queries(
          private_node_, {inputs_, detector_, environment_.inputs(), knowledge_, query_options_},
          [this] { process(); })),
      reconfigure_server_(private_node_) {
  detector_.set_fibers(inputs_.fibers());  // none yet, which can be asked about, too
  reconfigure_server_.setCallback(
      [this](AskedConfig& config, std::uint32_t /*level*/) { reconfigure(config); });
  tick_timer_ = node_.createSteadyTimer(ros::WallDuration(tick_interval),
                                        [this](const ros::SteadyTimerEvent&) { tick(); });
  retry_timer_ = node_.createSteadyTimer(
      ros::WallDuration(retry_interval), [this](const ros::SteadyTimerEvent&) { process(); }, false,
      false);
}

ProximityServer::~ProximityServer() { remove_tasks(queue_of(node_), this); }

void ProximityServer::schedule() {
  if (!std::exchange(is_scheduled_, true)) {
    add_task(queue_of(node_), this, [this] {
      is_scheduled_ = false;
      process();
    });
  }
}

/// @param may_repeat whether the last answer is to be given again where that is due
void ProximityServer::process(bool may_repeat) {
  const double time_before = inputs_.take_work_time();
  const Stopwatch stopwatch;
  const bool fibers_changed = inputs_.update();
  const bool environment_changed = environment_.update();
  const bool knowledge_changed = knowledge_.update();
  const bool repeats = may_repeat && (has_newcomers_ || is_heartbeat_due());
  if (fibers_changed || knowledge_changed || repeats) {
    answer(fibers_changed, time_before, stopwatch);
  } else if (environment_changed && inputs_.is_fresh() && environment_.has_listeners()) {
    answer_about_environment();
  }
  if (inputs_.is_waiting() || environment_.inputs().is_waiting()) {
    retry_timer_.start();
  } else {
    retry_timer_.stop();
  }
}

void ProximityServer::tick() {
  clock_.look();
  process(true);
  publish_markers_if_due();
  diagnostics_.update();
}

bool ProximityServer::is_heartbeat_due() const {
  return options_.heartbeat > 0.0 && !knowledge_.is_all_known() &&
         (ros::SteadyTime::now() - last_answer_).toSec() >= options_.heartbeat;
}

/// @param is_about_new_fibers false: about the same as the answer before, which have not moved
/// since
/// @param time_before         [s] that messages have taken before
/// @param stopwatch           of all else
void ProximityServer::answer(bool is_about_new_fibers, double time_before,
                             const Stopwatch& stopwatch) {
  last_answer_ = ros::SteadyTime::now();
  // These two cannot say what is unknown: they are about fibres, where there are any.
  const bool has_newcomers = std::exchange(has_newcomers_, false);
  const bool shows_fibers = is_about_new_fibers || (has_newcomers && inputs_.is_fresh());
  statistics_.begin();
  if (is_about_new_fibers) {
    take_fibers();
  } else {
    step_.rest();
  }
  statistics_.add_part("merge", time_before + inputs_.take_work_time());
  if (shows_fibers && fibers_publisher_.getNumSubscribers() > 0) {
    to_message(inputs_.fibers(), inputs_.names(), fibers_message_);
    fibers_message_.header = inputs_.header();
    fibers_publisher_.publish(fibers_message_);
  }
  if (shows_fibers && crossings_.is_wanted()) {
    const Stopwatch crossings_time;
    crossings_.publish(inputs_.fibers(), inputs_.header(), inputs_.names());
    statistics_.add_part("crossings", crossings_time.seconds());
  }
  const bool statistics = statistics_.has_listeners();
  drawing_is_due_ = markers_publisher_.getNumSubscribers() > 0;
  const bool everything = statistics || drawing_is_due_;
  if (everything || contacts_.has_listeners()) {
    detect();
    publish_contacts();
  } else {
    contacts_.skip();
  }
  if (environment_.is_used() && (everything || environment_.has_listeners())) {
    detect_in_environment();
  } else {
    environment_.skip();
  }
  if (prediction_.is_wanted()) {
    const Stopwatch prediction_time;
    prediction_.publish(query_options_, environment_, knowledge_);
    statistics_.add_part("prediction", prediction_time.seconds());
  } else {
    prediction_.skip();
  }
  publish_markers_if_due();
  const Stopwatch comparison_time;
  if (comparison_.publish_if_wanted()) {
    statistics_.add_part("comparison", comparison_time.seconds());
  }
  if (statistics) {
    publish_statistics(time_before + stopwatch.seconds());
  }
}

/// What is around the fibres has changed, and they have not.
void ProximityServer::answer_about_environment() {
  statistics_.begin();
  step_.rest();
  detect_in_environment();
}

void ProximityServer::take_fibers() {
  detector_.set_fibers(inputs_.fibers());
  read_state(inputs_, config_.continuous, newest_state_);
  step_.advance(newest_state_);
  crossings_.forget();
}

/// Of contacts of fibres with each other and with what is around them.
Completeness ProximityServer::completeness_of_all() const {
  Completeness of_all = knowledge_.completeness(Knowledge::About::FIBERS_AND_ENVIRONMENT);
  of_all.add_cut_off(detector_.detection().cut_off(query_options_));
  if (environment_.is_used()) {
    of_all.add_cut_off(environment_.detection().cut_off(query_options_));
  }
  return of_all;
}

/// @param time [s] of the answer
void ProximityServer::publish_statistics(double time) {
  const Completeness of_fibers = knowledge_.completeness(Knowledge::About::FIBERS);
  statistics_.publish(query_options_.kernel, of_fibers, completeness_of_all(), time);
}

/// Finds contacts and closest pair of the fibres. Where the engine cannot, the answer says so.
void ProximityServer::detect() {
  try {
    detector_.detect(query_options_, config_.minimum_distance);
  } catch (const std::invalid_argument& error) {
    ROS_ERROR_STREAM_THROTTLE(1.0, "engine " << options_.engine << ": " << error.what());
  }
  if (const std::string problem = detector_.detection().limit_problem(query_options_);
      !problem.empty()) {
    ROS_WARN_STREAM_THROTTLE(
        1.0, "fibres (engine " << options_.engine << "): " << problem << most_contacts_of());
  }
  statistics_.add_part("update", detector_.update_time());
  statistics_.add_part("contacts", detector_.detection().contact_time());
  if (config_.minimum_distance) {
    statistics_.add_part("minimum", detector_.detection().minimum_time());
  }
}

/// Which input most of the contacts are of, for the log.
std::string ProximityServer::most_contacts_of() const {
  std::map<std::string, std::size_t> counts;
  for (const fiber::Contact& contact : detector_.detection().contacts().contacts) {
    ++counts[inputs_.input_of(contact.fiber_a).options().topic];
  }
  const auto most =
      std::max_element(counts.begin(), counts.end(),
                       [](const auto& x, const auto& y) { return x.second < y.second; });
  return most == counts.end() ? "" : ". Most are of input " + most->first;
}

/// What came into contact since the fibres before; nothing where that cannot be told, and the
/// answer is of its stamp alone.
std::optional<KnownMotion> ProximityServer::detect_motion() {
  std::optional<KnownMotion> motion;
  if (step_.is_motion()) {
    try {
      const Stopwatch stopwatch;
      motion.emplace(detect_motion_contacts(
          *motion_engine_, {step_.motion(), step_.time(), config_.motion_tolerance}, query_options_,
          detector_.detection().has_all_of(query_options_), motion_result_));
      statistics_.add_part("motion", stopwatch.seconds());
    } catch (const std::invalid_argument& error) {
      step_.refuse(error.what());
    }
  }
  if (!step_.problem().empty()) {
    ROS_WARN_STREAM_THROTTLE(
        1.0, "continuous: " << step_.problem() << "; this answer is of its stamp alone");
  }
  return motion;
}

/// Recognises the contacts that were found, and publishes them.
void ProximityServer::publish_contacts() {
  const std::optional<KnownMotion> motion = detect_motion();
  const Stopwatch stopwatch;
  const BodyNames names{inputs_.names(), {}};
  Completeness known = knowledge_.completeness(Knowledge::About::FIBERS);
  known.add_cut_off(detector_.detection().cut_off(query_options_));
  if (motion && !motion->result.complete) {
    known.add_cut_off(cut_off_text("pairs that move", query_options_));
  }
  const ContactAnswer answer{
      detector_.detection(), query_options_, motion ? &*motion : nullptr, known, knowledge_, names,
      inputs_.header()};
  diagnostics_.count(detector_.detection().cut_off(query_options_));
  contacts_.track(answer);
  passed_.add(contacts_.contacts());
  statistics_.add_part("touches", stopwatch.seconds());
  inputs_.doubt(detector_.update_time() + detector_.detect_time() + stopwatch.seconds());
  contacts_.publish(answer, config_.gradients, detector_.update_time());
}

void ProximityServer::detect_in_environment() {
  // Objects may have moved where fibres have not.
  const ContinuousStep step{step_.motion(), step_.time(), config_.motion_tolerance};
  try {
    environment_.detect(query_options_, config_.minimum_distance,
                        step_.is_motion() || step_.rests() ? &step : nullptr);
  } catch (const std::invalid_argument& error) {
    ROS_WARN_STREAM_THROTTLE(
        1.0, "environment, continuous: " << error.what() << "; this answer is of its stamp alone");
    environment_.detect(query_options_, config_.minimum_distance, nullptr);
  }
  if (const std::string problem = environment_.detection().limit_problem(query_options_);
      !problem.empty()) {
    ROS_WARN_STREAM_THROTTLE(1.0, "environment: " << problem);
  }
  statistics_.add_part("environment_update", environment_.update_time());
  statistics_.add_part("environment_contacts", environment_.detection().contact_time());
  if (config_.minimum_distance) {
    statistics_.add_part("environment_minimum", environment_.detection().minimum_time());
  }
  if (environment_.motion_time() > 0.0) {
    statistics_.add_part("environment_motion", environment_.motion_time());
  }
  environment_.publish(query_options_, knowledge_, config_.gradients);
}

void ProximityServer::publish_markers_if_due() {
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (!drawing_is_due_ || (now - last_drawing_).toSec() * options_.marker_rate < 1.0) {
    return;
  }
  drawing_is_due_ = false;
  last_drawing_ = now;
  boxes_.clear();
  if (marker_options_.show_boxes) {
    detector_.engine().level_boxes(marker_options_.level, boxes_);
  }
  std::string cost;
  if (marker_options_.show_cost) {
    cost =
        cost_text(name_of(query_options_.kernel), detector_.update_time() + detector_.detect_time(),
                  detector_.detection().contact_error(), detector_.detection().is_complete());
  }
  if (marker_options_.show_crossings) {
    crossings_.find(inputs_.fibers(), inputs_.header());
  }
  EnvironmentMarkerOptions around_options;
  // What was detected while there was something around is not to be seen any more when there is
  // not.
  const bool is_used = environment_.is_used();
  around_options.show_objects = is_used && config_.show_objects;
  around_options.show_distances = is_used && config_.show_contacts;
  around_options.show_nearest = is_used && config_.show_nearest;
  std::vector<LegendLine> legend;
  // Where fibres may touch all that is around them, there are none to explain.
  has_shown_distances_ =
      has_shown_distances_ || !environment_.detection().contacts().contacts.empty();
  if (marker_options_.show_legend) {
    EnvironmentMarkerOptions explained = around_options;
    explained.show_distances = explained.show_distances && has_shown_distances_;
    legend = legend_lines(marker_options_, explained, query_options_.margin);
  }
  passed_.forget_old();
  const Completeness completeness = completeness_of_all();
  const CrossingDrawing crossings{crossings_.crossings(), crossings_.view()};
  const Drawing drawing{inputs_.fibers(),
                        detector_.detection().contacts().contacts,
                        detector_.detection().minimum(),
                        boxes_,
                        cost,
                        &crossings,
                        &inputs_.names(),
                        &legend,
                        &passed_.contacts(),
                        &completeness.unknown()};
  marker_builder_.build(inputs_.header(), drawing, marker_options_, markers_message_);
  const Detection& around = environment_.detection();
  environment_markers_.append(inputs_.header(),
                              {inputs_.fibers(), environment_.environment().objects(),
                               around.contacts().contacts, around.minimum()},
                              around_options, markers_message_);
  markers_publisher_.publish(markers_message_);
}

void ProximityServer::reconfigure(AskedConfig& config) {
  try {
    if (!config.problem().empty()) {
      throw std::invalid_argument(config.problem());
    }
    check(private_node_, config);
  } catch (const std::invalid_argument& error) {
    ROS_ERROR_STREAM("parameters stay as they were: " << error.what());
    config = config_;  // the server announces what is really in use
    return;
  }
  config_ = static_cast<const fiber_proximity::ProximityConfig&>(config);
  query_options_ = to_query_options(config);
  if (const std::string overridden = overridden_by_accuracy(config, query_options_);
      !overridden.empty()) {
    ROS_WARN_STREAM("parameter " << private_node_.resolveName("accuracy") << " is "
                                 << config.accuracy << ", which overrides " << overridden
                                 << "; accuracy custom uses them");
  }
  comparison_.switch_on(config.compare);
  prediction_.configure({config.prediction, static_cast<std::size_t>(config.prediction_frames),
                         config.motion_tolerance});
  marker_options_.show_fibers = config.show_fibers;
  marker_options_.show_contacts = config.show_contacts;
  marker_options_.show_passed = config.continuous && config.show_contacts;
  marker_options_.show_nearest = config.show_nearest;
  marker_options_.show_cost = config.show_cost;
  marker_options_.show_boxes = config.show_boxes;
  marker_options_.show_crossings = config.show_crossings;
  marker_options_.show_names = config.show_names;
  marker_options_.show_legend = config.show_legend;
  marker_options_.level = static_cast<std::uint32_t>(config.box_level);
}

}  // namespace fiber_proximity_ros

#include <fiber_proximity/ContactArray.h>
#include <fiber_proximity/ContactEvent.h>
#include <fiber_proximity/FiberArray.h>
#include <fiber_proximity/TimeToContact.h>

#include <atomic>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "benchmark/commands.hpp"
#include "benchmark/running_node.hpp"
#include "src/tools/progress.hpp"

namespace fiber {
namespace {

using fiber_proximity::ContactArray;
using fiber_proximity::FiberArray;

struct LatencyRequest : RunningNodeRequest {
  LatencyRequest() {
    rate = 100.0;
    contacts = "proximity/contacts";
  }

  std::uint32_t cables = 10;
  std::uint32_t points = 100;  // per cable
  std::string events = "proximity/contact_events";
  std::string times = "proximity/time_to_contact";
  bool continuous = false;  // whether to listen to these two as well
};

/// Cables of 1 m side by side, swaying so that neighbours touch here and there.
FiberArray make_cables(const LatencyRequest& request, const ros::Time& stamp, double time) {
  constexpr double radius = 0.005;   // [m]
  constexpr double spacing = 0.012;  // [m]
  constexpr double sway = 0.004;     // [m]
  constexpr double two_pi = 6.283185307179586;
  FiberArray message;
  message.header.stamp = stamp;
  message.header.frame_id = request.frame;
  message.offsets.push_back(0);
  for (std::uint32_t cable = 0; cable < request.cables; ++cable) {
    for (std::uint32_t i = 0; i < request.points; ++i) {
      geometry_msgs::Point point;
      point.x = static_cast<double>(i) / (request.points - 1);
      point.y = cable * spacing + sway * std::sin(two_pi * (3.0 * point.x + 0.4 * cable + time));
      message.points.push_back(point);
    }
    message.offsets.push_back(static_cast<std::uint32_t>(message.points.size()));
  }
  message.radii.push_back(radius);
  return message;
}

/// Polls until the condition holds or the time is over; whether it held.
template <class Condition>
bool wait_until(double seconds, const Condition& condition) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(seconds);
  while (ros::ok() && !condition()) {
    if (ros::WallTime::now() > end) {
      return false;
    }
    ros::WallDuration(0.005).sleep();
  }
  return condition();
}

/// The node under test between a publisher and a subscriber.
class LatencyRun {
 public:
  explicit LatencyRun(const LatencyRequest& request)
      : request_(request),
        publisher_(node_.advertise<FiberArray>(request.topic, 1)),
        subscriber_(node_.subscribe(request.contacts, 100, &LatencyRun::on_contacts, this,
                                    ros::TransportHints().tcpNoDelay())) {
    if (request.continuous) {
      using fiber_proximity::ContactEvent;
      using fiber_proximity::TimeToContact;
      others_ = {node_.subscribe<ContactEvent>(
                     request.events, 10000,
                     [this](const ContactEvent::ConstPtr& /*event*/) { ++events_; }),
                 node_.subscribe<TimeToContact>(request.times, 100,
                                                [this](const TimeToContact::ConstPtr& times) {
                                                  predictions_ += times->problem.empty() ? 1 : 0;
                                                })};
    }
    spinner_.start();
  }

  void run() {
    if (!wait_until(request_.timeout, [this] { return publisher_.getNumSubscribers() > 0; })) {
      throw std::runtime_error("nobody subscribes to " + publisher_.getTopic());
    }
    if (!wait_until(request_.timeout, [this] { return subscriber_.getNumPublishers() > 0; })) {
      throw std::runtime_error("nobody publishes " + subscriber_.getTopic());
    }
    // The first messages build the node's tree and find its memory: they are not measured.
    publish(request_.timeout, [this] { return !log_.times_ms().empty(); });
    if (log_.times_ms().empty()) {
      throw std::runtime_error("no answer on " + subscriber_.getTopic() +
                               " to what is published on " + publisher_.getTopic());
    }
    log_.clear();
    published_ = 0;
    events_ = 0;
    predictions_ = 0;
    publish(request_.seconds, [] { return false; });
    wait_until(1.0, [this] { return log_.pending() == 0; });
  }

  std::size_t published() const { return published_; }
  std::vector<double> latencies_ms() const { return log_.times_ms(); }
  std::size_t contacts() const { return contacts_; }
  std::size_t events() const { return events_; }
  std::size_t predictions() const { return predictions_; }

 private:
  void on_contacts(const ContactArray& contacts) {
    log_.receive(contacts.header.stamp, contacts.header.stamp);
    contacts_ = contacts.contacts.size();
  }

  template <class IsEnough>
  void publish(double seconds, const IsEnough& is_enough) {
    publish_at_rate(request_, seconds, is_enough, [this](double time) {
      const ros::Time stamp = ros::Time::now();
      const FiberArray cables = make_cables(request_, stamp, time);
      log_.send(stamp);
      publisher_.publish(cables);
      ++published_;
      progress_.show(std::to_string(published_) + " messages");
    });
  }

  const LatencyRequest& request_;
  TravelLog<ros::Time> log_;
  Progress progress_;
  std::size_t published_ = 0;
  ros::NodeHandle node_;
  ros::Publisher publisher_;
  std::atomic<std::size_t> contacts_{0};  // of the newest answer
  std::atomic<std::size_t> events_{0};
  std::atomic<std::size_t> predictions_{0};
  ros::Subscriber subscriber_;
  std::vector<ros::Subscriber> others_;
  ros::AsyncSpinner spinner_{1};  // last: stops before what its callbacks use
};

ExitCode run_latency(const LatencyRequest& request) {
  connect_to_ros();
  LatencyRun run(request);
  run.run();
  const std::vector<double> latencies = run.latencies_ms();
  if (latencies.empty()) {
    throw std::runtime_error("none of " + std::to_string(run.published()) +
                             " messages was answered");
  }
  BenchmarkRow result{{"cables", request.cables},     {"points", request.points},
                      {"rate", request.rate},         {"published", run.published()},
                      {"answered", latencies.size()}, {"contacts", run.contacts()}};
  add_quantiles(latencies, result);
  if (request.continuous) {
    result["events"] = run.events();
    result["predictions"] = run.predictions();
  }
  print_fields(result, request.json);
  return SUCCEEDED;
}

}  // namespace

void add_latency_command(CLI::App& app, Command& command) {
  const auto request = std::make_shared<LatencyRequest>();
  CLI::App* const latency = add_subcommand(
      app, command, "latency",
      "time from publishing cables to a running node to the arrival of their contacts", request,
      run_latency);
  add_count(*latency, "--cables", request->cables, "number of cables");
  add_count(*latency, "--points", request->points, "per cable", 2);
  add_running_node_options(*latency, *request, "[Hz]");
  latency->add_flag("--continuous", request->continuous,
                    "listen to the node's ~contact_events and ~time_to_contact, too");
  add_value(*latency, "--events", request->events, "the node's ContactEvent output");
  add_value(*latency, "--times", request->times, "the node's TimeToContact output");
}

}  // namespace fiber

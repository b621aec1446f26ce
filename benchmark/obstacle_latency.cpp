#include <fiber_proximity/ContactArray.h>
#include <fiber_proximity/FiberArray.h>
#include <fiber_proximity/ObstacleArray.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <random>
#include <stdexcept>

#include "benchmark/commands.hpp"
#include "benchmark/running_node.hpp"
#include "src/tools/progress.hpp"

namespace fiber {
namespace {

using fiber_proximity::ContactArray;
using fiber_proximity::FiberArray;
using fiber_proximity::Obstacle;
using fiber_proximity::ObstacleArray;
using Clock = std::chrono::steady_clock;

struct ObstacleLatencyRequest : RunningNodeRequest {
  ObstacleLatencyRequest() {
    rate = 20.0;
    contacts = "proximity/environment_contacts";
  }

  double bad_rate = 1.0;        // of obstacles in an unknown frame [Hz]
  std::uint32_t triangles = 0;  // of a mesh
  double mesh_period = 2.0;     // [s] between meshes
  std::string obstacles = "proximity/obstacles";
};

constexpr double radius = 0.01;       // of ball and fibre [m]
constexpr double first_height = 1.0;  // of the ball's centre above the fibre [m]
constexpr double step = 1e-3;         // by which it rises with each message [m]

Obstacle obstacle(const std::string& id, const std::string& frame, double height) {
  Obstacle obstacle;
  obstacle.header.frame_id = frame;
  obstacle.id = id;
  obstacle.operation = Obstacle::ADD;
  obstacle.pose.position.z = height;
  obstacle.pose.orientation.w = 1.0;
  return obstacle;
}

Obstacle ball(const std::string& id, const std::string& frame, double height) {
  Obstacle ball = obstacle(id, frame, height);
  ball.primitives.resize(1);
  ball.primitives[0].type = shape_msgs::SolidPrimitive::SPHERE;
  ball.primitives[0].dimensions = {radius};
  return ball;
}

/// Triangles in no order, far away.
Obstacle thicket(const ObstacleLatencyRequest& request) {
  constexpr double far_away = 1e4;  // [m]
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  Obstacle thicket = obstacle("thicket", request.frame, far_away);
  thicket.meshes.resize(1);
  for (std::uint32_t i = 0; i < request.triangles; ++i) {
    thicket.meshes[0].triangles.emplace_back();
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      thicket.meshes[0].triangles.back().vertex_indices[corner] = 3 * i + corner;
      geometry_msgs::Point point;
      point.x = coordinate(random);
      point.y = coordinate(random);
      point.z = coordinate(random);
      thicket.meshes[0].vertices.push_back(point);
    }
  }
  return thicket;
}

/// A moving obstacle among bad ones and large ones, and a node that tells how far it is.
class ObstacleRun {
 public:
  explicit ObstacleRun(const ObstacleLatencyRequest& request)
      : request_(request),
        fibers_(node_.advertise<FiberArray>(request.topic, 1)),
        obstacles_(node_.advertise<ObstacleArray>(request.obstacles, 1000)),
        subscriber_(node_.subscribe(request.contacts, 100, &ObstacleRun::on_contacts, this,
                                    ros::TransportHints().tcpNoDelay())) {
    if (request.triangles > 0) {
      thicket_.obstacles = {thicket(request)};
    }
    spinner_.start();
  }

  void run() {
    publish(request_.timeout, false, [this] { return !log_.times_ms().empty(); });
    if (log_.times_ms().empty()) {
      throw std::runtime_error("no answer on " + subscriber_.getTopic() +
                               " to what is published on " + fibers_.getTopic() + " and " +
                               obstacles_.getTopic());
    }
    log_.clear();
    longest_gap_ms_ = 0.0;
    publish(request_.seconds, true, [] { return false; });
  }

  /// How long it took until the node had the ball at a place or further.
  std::vector<double> lags_ms() const { return log_.times_ms(); }
  double longest_gap_ms() const { return longest_gap_ms_; }

 private:
  void on_contacts(const ContactArray& contacts) {
    const double height = contacts.minimum_distance + 2.0 * radius;
    log_.receive(
        0, static_cast<std::size_t>(std::max(0.0, std::round((height - first_height) / step))));
    const Clock::time_point now = Clock::now();
    if (last_.time_since_epoch().count() != 0) {
      longest_gap_ms_ = std::max(longest_gap_ms_.load(), milliseconds(now - last_));
    }
    last_ = now;
  }

  void publish_obstacle(const Obstacle& obstacle) {
    ObstacleArray message;
    message.obstacles = {obstacle};
    obstacles_.publish(message);
  }

  void publish_fiber() {
    FiberArray fiber;
    fiber.header.frame_id = request_.frame;
    fiber.header.stamp = ros::Time::now();
    fiber.offsets = {0, 2};
    fiber.radii = {radius};
    fiber.points.resize(2);
    fiber.points[0].x = -1.0;
    fiber.points[1].x = 1.0;
    fibers_.publish(fiber);
  }

  template <class IsEnough>
  void publish(double seconds, bool disturbed, const IsEnough& is_enough) {
    double next_bad = 0.0;
    double next_mesh = 0.0;
    publish_at_rate(request_, seconds, is_enough, [&](double time) {
      if (disturbed && request_.bad_rate > 0.0 && time >= next_bad) {
        publish_obstacle(ball("lost", "no_such_frame", 0.0));
        next_bad = time + 1.0 / request_.bad_rate;
      }
      if (disturbed && request_.triangles > 0 && time >= next_mesh) {
        obstacles_.publish(thicket_);
        next_mesh = time + request_.mesh_period;
      }
      publish_fiber();
      log_.send(next_);
      publish_obstacle(
          ball("ball", request_.frame, first_height + step * static_cast<double>(next_++)));
      progress_.show(std::to_string(log_.times_ms().size()) + " places");
    });
  }

  const ObstacleLatencyRequest& request_;
  ObstacleArray thicket_;
  TravelLog<std::size_t> log_;             // of the ball, by the number of its place
  std::size_t next_ = 0;                   // place
  std::atomic<double> longest_gap_ms_{0};  // between answers
  Clock::time_point last_;
  Progress progress_;
  ros::NodeHandle node_;
  ros::Publisher fibers_;
  ros::Publisher obstacles_;
  ros::Subscriber subscriber_;
  ros::AsyncSpinner spinner_{1};  // last: stops before what its callbacks use
};

ExitCode run_obstacle_latency(const ObstacleLatencyRequest& request) {
  connect_to_ros();
  ObstacleRun obstacles(request);
  obstacles.run();
  const std::vector<double> lags = obstacles.lags_ms();
  if (lags.empty()) {
    throw std::runtime_error("the moving obstacle was not seen to move");
  }
  BenchmarkRow result{{"rate", request.rate},
                      {"bad_rate", request.bad_rate},
                      {"triangles", request.triangles},
                      {"places", lags.size()}};
  add_quantiles(lags, result);
  result["longest_gap_ms"] = obstacles.longest_gap_ms();
  print_fields(result, request.json);
  return SUCCEEDED;
}

}  // namespace

void add_obstacle_latency_command(CLI::App& app, Command& command) {
  const auto request = std::make_shared<ObstacleLatencyRequest>();
  CLI::App* const latency = add_subcommand(
      app, command, "obstacle_latency",
      "time from publishing a moving obstacle to a running node to its being there, beside "
      "obstacles that are bad or large",
      request, run_obstacle_latency);
  add_running_node_options(*latency, *request, "of the moving obstacle [Hz]");
  add_value(*latency, "--bad-rate", request->bad_rate, "of obstacles in an unknown frame [Hz]",
            CLI::Range(0.0, 1e5));
  add_count(*latency, "--triangles", request->triangles, "of a mesh; 0 for none", 0);
  add_value(*latency, "--mesh-period", request->mesh_period, "from mesh to mesh [s]",
            CLI::Range(0.1, 1e5));
  add_value(*latency, "--obstacles", request->obstacles, "the node's obstacles");
}

}  // namespace fiber

#pragma once

#include <ros/ros.h>

#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "benchmark/options.hpp"
#include "benchmark/report.hpp"
#include "src/accuracy/statistics.hpp"

namespace fiber {

/// Options of measurements that ask a running node.
struct RunningNodeRequest {
  double rate = 0.0;  // of messages [Hz]
  double seconds = 10.0;
  double timeout = 10.0;  // to wait for the node [s]
  std::string topic = "fibers";
  std::string contacts;
  std::string frame = "world";
  bool json = false;
};

inline void add_running_node_options(CLI::App& app, RunningNodeRequest& request,
                                     const std::string& rate_meaning) {
  add_value(app, "--rate", request.rate, rate_meaning, CLI::Range(0.1, 1e5));
  add_value(app, "--seconds", request.seconds, "to measure", CLI::Range(0.1, 1e5));
  add_value(app, "--timeout", request.timeout, "to wait for the node [s]", CLI::Range(0.0, 1e5));
  add_value(app, "--topic", request.topic, "the node's FiberArray input");
  add_value(app, "--contacts", request.contacts, "the node's ContactArray output");
  add_value(app, "--frame", request.frame, "of what is published");
  app.add_flag("--json", request.json, "a JSON object instead of lines");
}

/// Makes this process a node.
/// @throws std::runtime_error without a master
inline void connect_to_ros() {
  ros::init(ros::M_string(), "fiber_bench",
            ros::init_options::AnonymousName | ros::init_options::NoRosout);
  if (!ros::master::check()) {
    throw std::runtime_error("no ROS master at " + ros::master::getURI());
  }
}

/// Calls publish(time) at the rate of the request, with the time since the start [s], until that is
/// over or there is enough.
template <class Publish, class IsEnough>
void publish_at_rate(const RunningNodeRequest& request, double seconds, const IsEnough& is_enough,
                     const Publish& publish) {
  const ros::WallTime start = ros::WallTime::now();
  ros::WallRate rate(request.rate);
  for (double time = 0.0; ros::ok() && time < seconds && !is_enough();
       time = (ros::WallTime::now() - start).toSec()) {
    publish(time);
    rate.sleep();
  }
}

/// The messages that are under way, by what tells them apart, and how long the others took.
template <class Key>
class TravelLog {
  using Clock = std::chrono::steady_clock;

 public:
  void send(const Key& key) {
    const std::lock_guard lock(mutex_);
    sent_[key] = Clock::now();
  }

  /// Notes that all from the first up to the last have arrived.
  void receive(const Key& first, const Key& last) {
    const Clock::time_point now = Clock::now();
    const std::lock_guard lock(mutex_);
    for (auto message = sent_.lower_bound(first);
         message != sent_.end() && !(last < message->first); message = sent_.erase(message)) {
      times_ms_.push_back(milliseconds(now - message->second));
    }
  }

  void clear() {
    const std::lock_guard lock(mutex_);
    sent_.clear();
    times_ms_.clear();
  }

  std::size_t pending() const {
    const std::lock_guard lock(mutex_);
    return sent_.size();
  }
  std::vector<double> times_ms() const {
    const std::lock_guard lock(mutex_);
    return times_ms_;
  }

 private:
  mutable std::mutex mutex_;
  std::map<Key, Clock::time_point> sent_;
  std::vector<double> times_ms_;
};

/// Adds the median and other quantiles of times [ms].
inline void add_quantiles(const std::vector<double>& times_ms, BenchmarkRow& row) {
  row["median_ms"] = median(times_ms);
  row["p90_ms"] = quantile(times_ms, 0.9);
  row["p99_ms"] = quantile(times_ms, 0.99);
  row["max_ms"] = quantile(times_ms, 1.0);
}

}  // namespace fiber

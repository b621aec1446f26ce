#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/sim/scene/prediction.hpp"
#include "src/sim/scene/report.hpp"

namespace fiber {

/// Watches a scene that somebody moves on, and sums up what happens: the one place that does, for
/// predict() and for runs that go on writing frames.
class PredictionObserver {
 public:
  /// Begins where the scene is. It must outlive this.
  /// @throws std::invalid_argument for options that are not allowed
  PredictionObserver(const SimScene& scene, const PredictionOptions& options);

  /// [s] since the beginning
  double time() const { return scene_.stepper->time() - begin_; }

  /// Looks at the beginning, and at the end of each frame.
  void look();

  /// Keeps what a frame warns of. To be called after each: before the first one the last step is
  /// that of the running scene.
  void keep_warnings();

  /// Keeps where the fibres are.
  void sample();

  /// Tells why the scene goes no further.
  void stop(const std::string& problem) { prediction_.problem = problem; }

  /// To be called once.
  Prediction take();

 private:
  /// The bodies of a pair: whether the second one is an object, then the two.
  using Bodies = std::tuple<bool, std::uint32_t, std::uint32_t>;

  /// By rod and node.
  using NodeForces = std::map<std::pair<std::uint32_t, std::uint32_t>, GreatestForce>;

  void add_clearances(bool is_object);
  void add_forces(const RodForces& forces);
  template <class Force>
  void keep_greatest(const std::vector<Force>& forces, NodeForces& greatest) const;
  void add_touch(const Bodies& bodies, double force);

  const SimScene& scene_;
  const double begin_;  // [s]
  std::unique_ptr<ProximityEngine> engine_;
  FiberAssembly fibers_;
  QueryOptions query_;
  QueryResult result_;
  Prediction prediction_;
  std::map<Bodies, PredictedClearance> clearances_;
  std::map<Bodies, PredictedTouch> touches_;
  NodeForces holds_;
  NodeForces joints_;
  std::array<bool, SimWarning::kinds> is_warned_{};
};

/// Tells what has been found, a line for each: the least distance of each pair of bodies, who
/// presses on whom, the greatest tension of each fibre and force of each hold and joint, when, and
/// how complete that is.
/// @param scene  that it is of
/// @param margin [m] up to which least distances were looked for
std::string summary(const Prediction& prediction, const SimScene& scene, double margin);

}  // namespace fiber

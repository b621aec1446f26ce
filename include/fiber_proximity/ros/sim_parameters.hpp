#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "fiber_proximity/SimulationParameter.h"
#include "fiber_proximity/sim/effects/damping.hpp"
#include "fiber_proximity/sim/effects/drag.hpp"
#include "fiber_proximity/sim/effects/friction.hpp"
#include "fiber_proximity/sim/effects/gravity.hpp"

namespace fiber_proximity_ros {

/// Numbers of effects that can change between two steps, by the names that they have in scenes:
/// only those of effects that the scene names.
class SimParameters {
 public:
  using Value = std::vector<double>;

  // What is to be changed; all must outlive this.
  void add(fiber::Gravity& gravity, const Eigen::Vector3d& acceleration);
  void add(fiber::Damping& damping, double relaxation_time);
  void add(fiber::Drag& drag, const fiber::Drag::Options& options);
  void add(fiber::Friction& friction, const fiber::Friction::Options& options);

  /// Changes all of these, or none.
  /// @throws std::invalid_argument naming the parameter, its value and what is allowed
  void set(const std::vector<fiber_proximity::SimulationParameter>& parameters);

  /// All there are, by name.
  std::vector<fiber_proximity::SimulationParameter> all() const;

 private:
  /// By the name of the option; the numbers of one effect are checked and changed together.
  using Options = std::map<std::string, Value>;
  struct Entry {
    Options options;
    std::function<void(const Options&)> apply;  // throws for what is not allowed
  };

  void set_one(const fiber_proximity::SimulationParameter& parameter);

  std::map<std::string, Entry> effects_;
};

}  // namespace fiber_proximity_ros

#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "fiber_proximity/sim/scene/description.hpp"

namespace fiber {

/// A number of an effect, or several, that may change between two steps.
struct SimParameter {
  std::string name;  ///< of effect and option, as the scene has them: gravity.acceleration
  std::vector<double> value;
};

/// The parameters of the effects that a scene names.
class SimParameters {
 public:
  /// @param apply changes the effect; throws std::invalid_argument for what is not allowed
  void add(const std::string& effect, const EffectOptions& options,
           std::function<void(const EffectOptions&)> apply);

  /// Changes all of these, or none.
  /// @throws std::invalid_argument naming the parameter, its value and what is allowed
  void set(const std::vector<SimParameter>& parameters);

  /// All there are, by name.
  std::vector<SimParameter> all() const;

 private:
  struct Entry {
    EffectOptions options;
    std::function<void(const EffectOptions&)> apply;
  };

  void set_one(const SimParameter& parameter);

  std::map<std::string, Entry> effects_;
};

}  // namespace fiber

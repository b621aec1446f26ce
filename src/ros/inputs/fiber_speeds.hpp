#pragma once

#include <optional>
#include <vector>

#include "src/ros/inputs/fiber_message.hpp"

namespace fiber_proximity_ros {

/// How fast the fibres of an input move: the largest speed of a point of each between the last two
/// messages. It is a bound for as long as no point becomes faster than that.
class FiberSpeeds {
 public:
  /// Takes the newest message. Speeds are not known where it has other fibres than the one before,
  /// or its stamp does not rise.
  void take(const FiberMessage& before, const FiberMessage& newest);

  void forget() { speeds_.reset(); }

  /// [m/s] By fibre; none where nothing is known of them.
  const std::optional<std::vector<double>>& speeds() const { return speeds_; }

 private:
  std::optional<std::vector<double>> speeds_;
};

}  // namespace fiber_proximity_ros

#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/CheckFibers.h"
#include "fiber_proximity/environment/check_fibers.hpp"
#include "src/ros/server/query_target.hpp"

namespace fiber_proximity_ros {

/// What may touch fibres of these names.
using FindAllowed = std::function<fiber::AllowedPairs(const std::vector<std::string>&)>;

/// A candidate is held against itself, fibres and objects.
constexpr std::size_t queries_per_candidate = 3;

/// Hypothetical fibres of a request in the fixed frame.
/// @throws std::invalid_argument for fibres that are none, or have no radii
/// @throws TransformUnavailable
fiber::FiberAssembly to_candidate(const fiber_proximity::FiberArray& message,
                                  const FixedFrame& frame);

/// Answers for so many candidates or motions in all: nothing is known to touch those that the
/// deadline came before.
void leave_unread(std::size_t count, fiber_proximity::CheckFibers::Response& response);

/// The fibres that candidates are checked against: all, or all but those that they stand in for.
class PresentFibers {
 public:
  /// Refers to the target. With ignore_fibers there are none, and none are to be replaced.
  /// @throws std::invalid_argument for a fibre to be replaced that there is not
  PresentFibers(const QueryTarget& target, const fiber_proximity::CheckFibers::Request& request);

  /// What candidates of the request are to be checked against, but for what may touch.
  fiber::Surroundings surroundings() const { return surroundings_; }

  /// Contacts with these fibres, from the first one given on, count all fibres of the node then.
  void number_as_all(std::size_t first, fiber_proximity::CheckFibers::Response& response) const;

 private:
  void leave_out(const QueryTarget& target, const std::vector<std::string>& replaced);

  std::vector<std::uint32_t> kept_;
  fiber::FiberAssembly others_;
  std::unique_ptr<fiber::ProximityEngine> engine_of_others_;
  fiber::Surroundings surroundings_;
};

}  // namespace fiber_proximity_ros

#pragma once

#include <vector>

#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/query/engine.hpp"

namespace fiber {

/// What hypothetical fibres are checked against. Holds references: only for the call.
struct Surroundings {
  const ProximityEngine* fibers = nullptr;   ///< the fibres there are, nullptr to leave them out
  const Environment* environment = nullptr;  ///< nullptr to leave it out
  AllowedPairs allowed;                      ///< with objects of the environment
  bool self = true;                          ///< contacts among the candidate's own fibres count
};

/// What a candidate touches, each answer sorted by its key. What is not asked for, or needs no look
/// any more, has no contacts.
struct FiberCheck {
  QueryResult self;         ///< among the fibres of the candidate
  QueryResult fibers;       ///< of the candidate (a) with the fibres there are (b)
  QueryResult environment;  ///< of the candidate (a) with an object (fiber_b) and its shape

  bool is_free() const {
    return self.contacts.empty() && fibers.contacts.empty() && environment.contacts.empty();
  }
  /// Whether all pairs have been looked at; of a candidate that is not free some need not be.
  bool is_complete() const { return self.complete && fibers.complete && environment.complete; }
  /// Of one of the three answers.
  bool is_limit_reached() const {
    return self.limit_reached || fibers.limit_reached || environment.limit_reached;
  }
};

/// Whether fibres could be there: candidates for where a planner might put a cable, each an
/// assembly of its own, checked at the same time on all cores. The answers do not depend on how
/// many there are.
/// @param options of each of the three questions; with FIRST a candidate's check ends at its first
///                contact. A deadline is one for all candidates together: those it does not reach
///                are not complete
/// @param checks  by candidate; memory of an earlier call is reused
/// @throws std::invalid_argument for options that do not validate
void check_fibers(const std::vector<FiberAssembly>& candidates, const Surroundings& surroundings,
                  const QueryOptions& options, std::vector<FiberCheck>& checks);

}  // namespace fiber

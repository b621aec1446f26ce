#pragma once

#include <vector>

#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/query/motion.hpp"

namespace fiber {

/// All that hypothetical fibres are checked against. Holds references: only for the call.
struct Surroundings {
  const ProximityEngine* fibers = nullptr;   ///< the fibres there are, nullptr to leave them out
  const Environment* environment = nullptr;  ///< nullptr to leave it out
  AllowedPairs allowed;                      ///< with objects of the environment
  bool self = true;                          ///< contacts among the candidate's own fibres count
};

/// Contacts of a candidate, one answer for each kind. One that is not asked for, or not needed, has
/// no contacts.
template <class Answer>
struct CandidateCheck {
  Answer self;         ///< among the fibres of the candidate
  Answer fibers;       ///< of the candidate (a) with the fibres there are (b)
  Answer environment;  ///< of the candidate (a) with an object (fiber_b) and its shape

  /// Whether a contact was found.
  bool has_contact() const {
    return !self.contacts.empty() || !fibers.contacts.empty() || !environment.contacts.empty();
  }
  /// Whether all pairs have been looked at; of a candidate that has a contact some need not be.
  bool is_complete() const { return self.complete && fibers.complete && environment.complete; }
  /// Whether it is certain that there is no contact.
  bool is_free() const { return !has_contact() && is_complete(); }
  /// Whether it is known to be free, or not to be.
  bool is_decided() const { return has_contact() || is_complete(); }
  /// Whether one of the three answers has reached its limit.
  bool is_limit_reached() const {
    return self.limit_reached || fibers.limit_reached || environment.limit_reached;
  }
};

using FiberCheck = CandidateCheck<QueryResult>;  ///< each answer sorted by its key

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

/// A contact that a candidate has on its way.
struct PathContact {
  /// Times are in states: at 1.25 the candidate is a quarter of the way from state 1 to state 2.
  MotionContact when;
  /// Nearest points and distance at when.upper; where that is infinite, at when.lower.
  Contact where;
};

/// The contacts of a candidate on its way with itself, or with fibres or objects.
struct PathContacts {
  std::vector<PathContact> contacts;  ///< of each pair the first one; sorted by their keys
  bool limit_reached = false;         ///< there may be more
  bool complete = true;               ///< whether all pairs have been looked at
};

using MotionCheck = CandidateCheck<PathContacts>;  ///< of a candidate on its way

/// The states a candidate goes through: from one to the next each of its points moves linearly.
using FiberPath = std::vector<FiberAssembly>;

/// Whether fibres could move like this among fibres and objects that stand still: the edges of a
/// planner's graph, for example, checked at the same time on all cores. No contact is missed
/// between two states; those that there are at the first one count, at time 0. Of each segment the
/// larger radius of the two states counts.
/// @param options FIRST: the earliest contact of the whole motion, with whatever it is. LIMITED and
///                ALL: of each of the three on its own, the first contact of each pair. The pairing
///                and the neighbour skips are for contacts of the candidate with itself. The
///                deadline is one for all motions together: those it does not reach are not
///                complete. contact_limit and max_contacts are of each of the three answers of each
///                motion, pair_limit is of each step
/// @param checks  by motion; memory of an earlier call is reused
/// @throws std::invalid_argument for options that do not validate; for a motion of less than two
///         states, or one that changes its topology, naming both. Nothing has been checked then
/// @throws std::logic_error if the engine of surroundings.fibers has no fibres
void check_motions(const std::vector<FiberPath>& motions, const Surroundings& surroundings,
                   const MotionOptions& options, std::vector<MotionCheck>& checks);

}  // namespace fiber

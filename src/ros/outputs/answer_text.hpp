#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/query/options.hpp"

namespace fiber_proximity_ros {

/// A question about pairs, and what is known of its answer: of fibres with each other, or of fibres
/// with objects.
struct PairsAnswer {
  fiber::QueryOptions asked;

  bool was_all_there = true;   ///< all was there that it was asked about
  bool is_cut_off = false;     ///< a deadline or a limit came before all pairs were looked at
  bool has_failed = false;     ///< nothing could be asked
  bool limit_reached = false;  ///< as QueryResult has it

  std::size_t contacts = 0;    ///< that were found
  std::size_t uncertain = 0;   ///< of these, that are only possible, as inputs are uncertain
  double contact_error = 0.0;  ///< [m] the most by which the distance of one of them is wrong
  double others_lower = 0.0;   ///< [m] no other pair has a smaller true distance

  std::optional<double> minimum;  ///< [m] signed distance of the closest pair, if there is one
  double minimum_lower = 0.0;     ///< [m] bounds of the true distance of the closest pair
  double minimum_upper = 0.0;
};

/// A part of an answer.
struct AnswerPart {
  std::string name;  ///< as `parts` of Statistics.msg has it
  double seconds = 0.0;
  bool is_complete = true;  ///< nothing came before its end
};

/// An answer of the node.
struct Answer {
  PairsAnswer fibers;
  std::optional<PairsAnswer> objects;  ///< if there is anything around the fibres
  std::vector<AnswerPart> parts;
  double total_time = 0.0;  ///< [s] of all of it up to now
  double deadline = 0.0;    ///< [s] for all of it; 0 if there was none
  bool goes_on = false;     ///< there is more to come, such as its drawing
};

/// [s] Of the parts that bring what there is up to date, which no deadline can shorten.
double update_time(const Answer& answer);

/// Tells an answer, how much of it is proven and what it cost: a line about fibres, one about
/// objects and one about time, without an end of line behind the last.
///
///     robust: 18 of 18 contacts (each to 3.8e-17 m), closest 2.31 mm (to 1.2e-18 m)
///     objects: at least 3 contacts, cut off, closest 1.20 mm, true >= -5.00 mm
///     0.35 of 0.30 ms: contacts 0.10, environment_contacts 0.20 (incomplete), others 0.05
///
/// A number told as found, "18 of 18", is all there is. Bounds are rounded outwards, other
/// distances and times to the nearest digit. A pair counts as a contact as the kernel has it. Of
/// what is unknown or was cut off nothing is told as complete.
std::string answer_text(const Answer& answer);

}  // namespace fiber_proximity_ros

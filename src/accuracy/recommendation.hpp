#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "src/accuracy/setting_outcome.hpp"

namespace fiber {

/// The setting to take for a question, and why.
struct Recommendation {
  std::size_t index = 0;  ///< of the outcome
  std::string sentence;
};

/// Whether another setting is at least as accurate, by errors, doubts, contacts and completeness,
/// and clearly faster: its median takes less than 95 % of the time, beyond what two measurements
/// of one setting differ by, and beyond what chance may do to the medians. A deadline dominates
/// nothing: another frame may take longer.
bool is_dominated(const SettingOutcome& outcome, const SettingOutcome& other);

/// Whether any other one dominates each.
std::vector<bool> dominated(const std::vector<SettingOutcome>& outcomes);

/// Chooses among the settings of one question. Accurate enough are answers without a deadline
/// that miss and invent nothing and whose error and doubt are at most half of the tracker's noise,
/// which then adds an eighth to the error at most; without noise, those that are off by no more
/// than a nanometre or than the reference. The reference is taken if it takes at most three percent
/// longer than the fastest of these, else the most accurate that does: with the five percent of
/// is_dominated(), a second measurement comes to nothing better.
/// @param outcomes of one question, the reference among them
/// @param noise      [m] of a coordinate of the tracked points, where it is known
/// @param frame_time [s] from a message to the next, where it is known
Recommendation recommend(const std::vector<SettingOutcome>& outcomes, std::optional<double> noise,
                         std::optional<double> frame_time);

}  // namespace fiber

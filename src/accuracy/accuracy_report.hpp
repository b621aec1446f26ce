#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "src/accuracy/doubt_sources.hpp"
#include "src/accuracy/noise.hpp"
#include "src/accuracy/recommendation.hpp"
#include "src/accuracy/setting_outcome.hpp"

namespace fiber {

/// A question with all its settings, and what to take.
struct QuestionReport {
  std::string question;
  std::vector<SettingOutcome> outcomes;
  std::vector<bool> dominated;  ///< each of the outcomes
  Recommendation recommendation;

  const SettingOutcome& taken() const { return outcomes[recommendation.index]; }
};

/// Reports the measurements of one question, and which setting to take for it.
/// @param outcomes of all questions
/// @param noise      as recommend() has it
/// @param frame_time likewise
QuestionReport report_of(const std::string& question, const std::vector<SettingOutcome>& outcomes,
                         std::optional<double> noise, std::optional<double> frame_time);

/// All that was found out about the fibres of a file.
struct AccuracyReport {
  std::string file;
  std::size_t frames = 0;           ///< in the file
  std::size_t measured_frames = 0;  ///< of these
  std::size_t fibers = 0;           ///< in the first frame
  std::size_t segments = 0;
  double margin = 0.0;  ///< [m]
  TrackNoise track;
  std::optional<double> frame_time;       ///< [s]
  std::vector<QuestionReport> questions;  ///< the one that is asked about last
  std::vector<std::string> left_out;

  /// Whose the doubt is of the answers to a question with the setting that is recommended.
  DoubtSources doubt(const QuestionReport& question) const;

  /// Whether every bound that an answer stated encloses the truth.
  bool all_bounds_hold() const;
};

/// Tables for people, a recommendation below each; the last line is that of the last question.
std::string text_of(const AccuracyReport& report);

/// A header and a row per question and setting; the last line is a comment, the recommendation.
std::string csv_of(const AccuracyReport& report);

/// One line with one object.
std::string json_of(const AccuracyReport& report);

}  // namespace fiber

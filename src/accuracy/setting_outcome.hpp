#pragma once

#include <cstddef>
#include <optional>

#include "src/accuracy/answer_setting.hpp"

namespace fiber {

/// The times and errors of a setting, over the measured frames.
struct SettingOutcome {
  AnswerSetting setting;
  std::size_t answers = 0;  ///< measured
  double p50_ms = 0.0;      ///< of an update and a query together
  double p99_ms = 0.0;
  double deadline_ms = 0.0;  ///< of the query, 0 for none

  /// By what part the ratio of its median to the reference's may be off: the standard error of the
  /// median of their ratios on the same frames.
  double ratio_error = 0.0;

  double error = 0.0;  ///< [m] the largest, AnswerErrors::largest()
  double doubt = 0.0;  ///< [m] the largest that answers stated themselves

  double missed_percent = 0.0;    ///< of the contacts there are
  double invented_percent = 0.0;  ///< of those reported
  double complete_percent = 100.0;

  /// The share of answers whose bounds enclose the truth; none where none are stated.
  std::optional<double> bounds_kept_percent;
};

}  // namespace fiber

#pragma once

#include <optional>
#include <string>

#include "src/accuracy/noise.hpp"
#include "src/accuracy/setting_outcome.hpp"

namespace fiber {

/// Whose the doubt is about the gap of two fibres [m].
struct DoubtSources {
  /// Noise is hardly ever more than so many standard deviations: in three coordinates once in 900.
  static constexpr double deviations = 4.0;

  std::optional<double> tracker;  ///< of both fibres by `deviations`, where the noise is known
  double latency = 0.0;           ///< both fibres move for a frame, as their fastest points do
  double setting = 0.0;           ///< by what a tolerance, deadline or fewer points leave open
  double kernel = 0.0;            ///< what rounding leaves open

  /// [m] What a node should be told as the `uncertainty` of this input, where the noise is known.
  std::optional<double> uncertainty() const {
    return tracker ? std::make_optional(*tracker / 2.0) : std::nullopt;
  }
};

/// Whose the doubt is of a setting's answers.
/// @param taken     the setting
/// @param reference its question with the kernel alone
DoubtSources doubt_sources(const TrackNoise& track, const SettingOutcome& taken,
                           const SettingOutcome& reference);

/// As "tracker 16 mm, latency of a frame 8.4 mm, setting none, kernel 1.1e-13 mm; most is the
/// tracker's".
std::string text_of(const DoubtSources& doubt);

}  // namespace fiber

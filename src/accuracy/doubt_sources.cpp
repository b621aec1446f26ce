#include "src/accuracy/doubt_sources.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "src/accuracy/number_text.hpp"

namespace fiber {

DoubtSources doubt_sources(const TrackNoise& track, const SettingOutcome& taken,
                           const SettingOutcome& reference) {
  DoubtSources doubt;
  if (track.noise) {
    doubt.tracker = 2.0 * DoubtSources::deviations * *track.noise;
  }
  doubt.latency = 2.0 * track.step;
  const bool is_rounding = taken.setting.kind != SettingKind::TOLERANCE &&
                           taken.setting.kind != SettingKind::DEADLINE &&
                           taken.setting.kind != SettingKind::RESAMPLING;
  doubt.kernel = is_rounding ? taken.doubt : std::min(taken.doubt, reference.doubt);
  doubt.setting = taken.doubt > doubt.kernel ? taken.doubt - doubt.kernel : 0.0;
  return doubt;
}

std::string text_of(const DoubtSources& doubt) {
  const std::array<std::pair<const char*, double>, 4> parts{{{"tracker", doubt.tracker.value_or(0)},
                                                             {"latency", doubt.latency},
                                                             {"setting", doubt.setting},
                                                             {"kernel", doubt.kernel}}};
  const auto part = [](double length) { return length > 0.0 ? millimetres(length) : "none"; };
  const auto* const most = std::max_element(
      parts.begin(), parts.end(), [](const auto& x, const auto& y) { return x.second < y.second; });
  return "tracker " + (doubt.tracker ? part(*doubt.tracker) : "not known") +
         ", latency of a frame " + part(doubt.latency) + ", setting " + part(doubt.setting) +
         ", kernel " + part(doubt.kernel) +
         (most->second > 0.0 ? std::string("; most is the ") + most->first + "'s" : "");
}

}  // namespace fiber

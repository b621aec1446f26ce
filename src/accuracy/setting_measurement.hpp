#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/accuracy/setting_outcome.hpp"

namespace fiber {

/// The rest of a budget of time.
class TimeBudget {
 public:
  explicit TimeBudget(double seconds) : seconds_(seconds) {}

  double seconds() const { return seconds_; }
  bool is_used_up(double part = 1.0) const {
    return std::chrono::duration<double>(Clock::now() - start_).count() >= part * seconds_;
  }

 private:
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start_ = Clock::now();
  const double seconds_;
};

/// The times and errors of all settings, on the same frames.
struct SettingMeasurement {
  std::vector<SettingOutcome> outcomes;  ///< as the settings, without those left out
  std::size_t frames = 0;                ///< measured
  std::vector<std::string> left_out;     ///< what was not measured and why, a phrase each
};

/// Asks with all settings in turns, frame by frame, so that what slows the machine down for a while
/// slows all of them; who goes after whom changes from frame to frame. Each answer is held against
/// the exact one.
/// @param frames   at least one, each with segments
/// @param settings of several questions, the reference of each before its other settings
/// @param budget   after which no frame begins. The first frame warms up and is measured anyway
/// @param answers  of each setting; where there are fewer frames, they come again
/// @param progress is told what is being measured
SettingMeasurement measure_settings(const std::vector<FiberFrame>& frames,
                                    const std::vector<AnswerSetting>& settings,
                                    const TimeBudget& budget, std::size_t answers,
                                    const std::function<void(const std::string&)>& progress);

}  // namespace fiber

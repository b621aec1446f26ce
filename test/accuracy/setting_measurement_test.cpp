#include "src/accuracy/setting_measurement.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace fiber::test {
namespace {

/// A coil that closes and opens under a bar, in so many frames.
std::vector<FiberFrame> coils(std::size_t count) {
  std::vector<FiberFrame> frames;
  for (std::size_t i = 0; i < count; ++i) {
    const double phase = std::sin(0.2 * static_cast<double>(i));
    std::vector<Eigen::Vector3d> points;
    for (int k = 0; k < 60; ++k) {
      const double angle = 0.25 * k;
      points.emplace_back(0.1 * std::cos(angle), 0.1 * std::sin(angle),
                          (0.0022 + 0.001 * phase) * k);
    }
    points.emplace_back(-0.3, 0.0, 0.15);
    points.emplace_back(0.3, 0.0, 0.15);
    frames.push_back({static_cast<std::int64_t>(i), {points, {0, 60, 62}, {0.02}}, {}});
  }
  return frames;
}

SettingChoices choices() {
  SettingChoices choices;
  choices.options.margin = 0.02;
  choices.engine = "run_tree";
  choices.engine_options.threads = 1;
  choices.other_engines = {"brute_force"};
  choices.skins = {0.01};
  choices.chord_errors = {5e-3};
  return choices;
}

std::vector<AnswerSetting> all_settings() { return settings_of(compared_questions(), choices()); }

SettingMeasurement measured(std::size_t frames, double seconds) {
  return measure_settings(coils(frames), all_settings(), TimeBudget(seconds), frames,
                          [](const std::string&) {});
}

TEST(AnswerSettings, TheReferencesOfAllQuestionsComeFirst) {
  std::size_t count = 0;
  for (const AnswerSetting& setting : all_settings()) {
    EXPECT_EQ(setting.is_reference, count < compared_questions().size()) << setting.name;
    EXPECT_NO_THROW(validate(setting.options));
    EXPECT_EQ(setting.options.deadline, 0.0);
    ++count;
  }
  std::size_t alone = 0;
  for (const std::string& question : compared_questions()) {
    EXPECT_TRUE(settings_of(question, choices()).front().is_reference);
    alone += settings_of(question, choices()).size();
  }
  EXPECT_EQ(count, alone);
}

TEST(SettingMeasurement, EverySettingIsHeldAgainstTheExactAnswer) {
  const SettingMeasurement found = measured(21, 600.0);
  EXPECT_EQ(found.frames, 21U);
  EXPECT_GT(found.outcomes.size(), 30U);
  for (const SettingOutcome& outcome : found.outcomes) {
    SCOPED_TRACE(outcome.setting.question + " with " + outcome.setting.name);
    EXPECT_GE(outcome.answers, 21U);
    EXPECT_GT(outcome.p50_ms, 0.0);
    EXPECT_GE(outcome.p99_ms, outcome.p50_ms);
    EXPECT_EQ(outcome.bounds_kept_percent.value_or(100.0), 100.0);
    switch (outcome.setting.kind) {
      case SettingKind::DEADLINE:
        break;
      case SettingKind::TOLERANCE:
        EXPECT_LE(outcome.error, outcome.setting.options.tolerance);
        EXPECT_LE(outcome.doubt, 1.001 * outcome.setting.options.tolerance);
        EXPECT_EQ(outcome.missed_percent, 0.0);
        break;
      case SettingKind::RESAMPLING:
        EXPECT_GT(outcome.error, 1e-6);
        EXPECT_FALSE(outcome.bounds_kept_percent);
        break;
      default:
        EXPECT_LT(outcome.error, 1e-12);
        EXPECT_EQ(outcome.missed_percent, 0.0);
        EXPECT_EQ(outcome.invented_percent, 0.0);
        EXPECT_EQ(outcome.complete_percent, 100.0);
    }
  }
}

TEST(SettingMeasurement, WithoutTimeReferencesAreMeasuredOnce) {
  const SettingMeasurement found = measured(100, 1e-9);
  EXPECT_EQ(found.frames, 1U);
  ASSERT_EQ(found.outcomes.size(), compared_questions().size());
  for (const SettingOutcome& outcome : found.outcomes) {
    EXPECT_TRUE(outcome.setting.is_reference);
    EXPECT_EQ(outcome.answers, 1U);
  }
  EXPECT_EQ(found.left_out.size(), all_settings().size() - found.outcomes.size());
}

}  // namespace
}  // namespace fiber::test

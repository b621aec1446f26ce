#include "src/accuracy/recommendation.hpp"

#include <gtest/gtest.h>

#include <string>

#include "test/support/random.hpp"

namespace fiber::test {
namespace {

SettingOutcome outcome(SettingKind kind, const std::string& name, double ms, double error = 0.0) {
  SettingOutcome outcome;
  outcome.setting.kind = kind;
  outcome.setting.name = name;
  outcome.setting.is_reference = name == "robust";
  outcome.answers = 100;
  outcome.p50_ms = ms;
  outcome.p99_ms = 2.0 * ms;
  outcome.error = error;
  outcome.doubt = error;
  outcome.bounds_kept_percent = 100.0;
  return outcome;
}

SettingOutcome robust(double ms) { return outcome(SettingKind::KERNEL, "robust", ms); }

SettingOutcome tolerance(double length, double ms) {
  SettingOutcome result =
      outcome(SettingKind::TOLERANCE, "tolerance of " + std::to_string(length), ms, length);
  result.setting.options.tolerance = length;
  return result;
}

std::string taken(const std::vector<SettingOutcome>& outcomes,
                  std::optional<double> noise = std::nullopt) {
  return outcomes[recommend(outcomes, noise, std::nullopt).index].setting.name;
}

TEST(Recommendation, TheReferenceUnlessAnotherIsFaster) {
  const SettingOutcome exact = outcome(SettingKind::KERNEL, "exact", 0.98);
  EXPECT_EQ(taken({robust(1.0), exact}), "robust");
  EXPECT_EQ(taken({robust(1.0), outcome(SettingKind::KERNEL, "exact", 0.9)}), "exact");
  EXPECT_EQ(taken({robust(1.0), outcome(SettingKind::KERNEL, "exact", 1.2)}), "robust");
}

TEST(Recommendation, ChanceDoesNotCount) {
  SettingOutcome exact = outcome(SettingKind::KERNEL, "exact", 0.9);
  EXPECT_TRUE(is_dominated(robust(1.0), exact));
  exact.ratio_error = 0.08;
  EXPECT_EQ(taken({robust(1.0), exact}), "robust");
  EXPECT_FALSE(is_dominated(robust(1.0), exact));
  exact.ratio_error = 0.0;
  exact.answers = 3;
  EXPECT_EQ(taken({robust(1.0), exact}), "robust");
}

TEST(Recommendation, AToleranceOnlyWithinHalfOfTheNoise) {
  const std::vector<SettingOutcome> outcomes{robust(1.0), tolerance(1e-3, 0.7),
                                             tolerance(1e-2, 0.5)};
  EXPECT_EQ(taken(outcomes), "robust");
  EXPECT_EQ(taken(outcomes, 1.9e-3), "robust");
  EXPECT_EQ(taken(outcomes, 2.1e-3), outcomes[1].setting.name);
  EXPECT_EQ(taken(outcomes, 2.1e-2), outcomes[2].setting.name);
}

TEST(Recommendation, OfThoseAsFastTheMostAccurate) {
  const std::vector<SettingOutcome> outcomes{robust(1.0), tolerance(1e-5, 0.71),
                                             tolerance(1e-3, 0.7)};
  EXPECT_EQ(taken(outcomes, 0.01), outcomes[1].setting.name);
  const std::vector<SettingOutcome> close{robust(1.0), tolerance(1e-5, 0.98),
                                          tolerance(1e-3, 0.96)};
  EXPECT_EQ(taken(close, 0.01), close[2].setting.name) << "the other one gains nothing";
}

TEST(Recommendation, NeverWhatMayGoWrongElsewhere) {
  const SettingOutcome deadline = outcome(SettingKind::DEADLINE, "deadline at 50 %", 0.5);
  EXPECT_EQ(taken({robust(1.0), deadline}, 0.1), "robust") << "complete in these frames only";
  SettingOutcome other = outcome(SettingKind::ENGINE, "engine", 0.5);
  EXPECT_EQ(taken({robust(1.0), other}), "engine");
  for (double SettingOutcome::*wrong :
       {&SettingOutcome::missed_percent, &SettingOutcome::invented_percent}) {
    SettingOutcome missing = other;
    missing.*wrong = 0.1;
    EXPECT_EQ(taken({robust(1.0), missing}), "robust");
  }
  other.bounds_kept_percent = 99.9;
  EXPECT_EQ(taken({robust(1.0), other}), "robust");
}

TEST(Recommendation, WhatIsStatedCountsAsWhatIsMeasured) {
  SettingOutcome lucky = tolerance(1e-2, 0.5);
  lucky.error = 0.0;
  EXPECT_EQ(taken({robust(1.0), lucky}, 1e-3), "robust");
}

TEST(Recommendation, NeverDominatedInASecondMeasurement) {
  Random random;
  const auto anything = [&] { return random.uniform(0.3, 3.0); };
  for (int round = 0; round < 2000; ++round) {
    std::vector<SettingOutcome> first{robust(anything())};
    for (const double length : {1e-5, 1e-4, 1e-3, 1e-2}) {
      first.push_back(tolerance(length, anything() * first[0].p50_ms));
    }
    first.push_back(outcome(SettingKind::KERNEL, "exact", anything()));
    first.push_back(outcome(SettingKind::THREADS, "one thread", anything()));
    std::vector<SettingOutcome> second = first;
    for (SettingOutcome& outcome : second) {
      outcome.p50_ms *= random.uniform(0.992, 1.008);
    }
    const std::size_t index = recommend(first, 1e-3 * anything(), std::nullopt).index;
    EXPECT_FALSE(dominated(second)[index]) << round;
  }
}

TEST(Recommendation, DominatedIsWhoIsNotMoreAccurateAndSlower) {
  const SettingOutcome slow = tolerance(1e-3, 1.0);
  EXPECT_TRUE(is_dominated(slow, tolerance(1e-4, 0.9)));
  EXPECT_TRUE(is_dominated(slow, tolerance(1e-3, 0.9)));
  EXPECT_FALSE(is_dominated(slow, tolerance(1e-2, 0.9)));
  EXPECT_FALSE(is_dominated(slow, tolerance(1e-4, 0.96))) << "the same but for the measurement";
  SettingOutcome less = tolerance(1e-4, 0.5);
  less.missed_percent = 1.0;
  EXPECT_FALSE(is_dominated(slow, less));
  SettingOutcome rounded = robust(0.9);
  rounded.error = 1e-16;
  EXPECT_TRUE(is_dominated(outcome(SettingKind::KERNEL, "exact", 1.0), rounded))
      << "nobody minds a rounding";
}

TEST(Recommendation, TheSentenceTellsWhy) {
  SettingOutcome deadline = outcome(SettingKind::DEADLINE, "deadline at 25 %", 0.2, 0.01);
  deadline.complete_percent = 40.0;
  const std::vector<SettingOutcome> outcomes{robust(0.06),
                                             outcome(SettingKind::KERNEL, "exact", 0.0672),
                                             tolerance(1e-3, 0.0588), deadline};
  const std::string sentence = recommend(outcomes, 2e-3, std::nullopt).sentence;
  EXPECT_EQ(sentence,
            "take robust: 0.06 ms; a " + outcomes[2].setting.name +
                " saves 2 %, exact costs 12 %, a deadline at 25 % leaves 60 % of the answers "
                "incomplete; your tracker's noise of 2 mm is larger than all errors but those of "
                "deadlines");
  const std::string unknown = recommend(outcomes, std::nullopt, 1e-4).sentence;
  EXPECT_NE(unknown.find("noise is not known"), std::string::npos);
  EXPECT_NE(unknown.find("more than the 0.1 ms of a frame"), std::string::npos) << unknown;
}

}  // namespace
}  // namespace fiber::test

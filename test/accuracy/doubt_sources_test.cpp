#include "src/accuracy/doubt_sources.hpp"

#include <gtest/gtest.h>

namespace fiber::test {
namespace {

SettingOutcome outcome(SettingKind kind, double doubt) {
  SettingOutcome outcome;
  outcome.setting.kind = kind;
  outcome.doubt = doubt;
  return outcome;
}

TEST(DoubtSources, TellsTrackerLatencySettingAndKernelApart) {
  TrackNoise track;
  track.noise = 0.002;
  track.step = 0.005;
  const SettingOutcome robust = outcome(SettingKind::KERNEL, 1e-16);
  const DoubtSources of_robust = doubt_sources(track, robust, robust);
  EXPECT_DOUBLE_EQ(of_robust.tracker.value(), 0.016);
  EXPECT_DOUBLE_EQ(of_robust.uncertainty().value(), 0.008);
  EXPECT_EQ(of_robust.latency, 0.01);
  EXPECT_EQ(of_robust.setting, 0.0);
  EXPECT_EQ(of_robust.kernel, 1e-16);
  EXPECT_EQ(text_of(of_robust),
            "tracker 16 mm, latency of a frame 10 mm, setting none, kernel 1e-13 mm; most is the "
            "tracker's");

  const DoubtSources tolerant = doubt_sources(track, outcome(SettingKind::TOLERANCE, 0.1), robust);
  EXPECT_NEAR(tolerant.setting, 0.1, 1e-12);
  EXPECT_EQ(tolerant.kernel, 1e-16);
  EXPECT_NE(text_of(tolerant).find("most is the setting's"), std::string::npos);
}

TEST(DoubtSources, SaysWhatIsNotKnown) {
  const SettingOutcome exact = outcome(SettingKind::KERNEL, 0.0);
  const DoubtSources doubt = doubt_sources({}, exact, exact);
  EXPECT_FALSE(doubt.uncertainty());
  EXPECT_EQ(text_of(doubt),
            "tracker not known, latency of a frame none, setting none, kernel none");
}

}  // namespace
}  // namespace fiber::test

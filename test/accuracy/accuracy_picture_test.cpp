#include "src/accuracy/accuracy_picture.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "src/accuracy/number_text.hpp"

namespace fiber::test {
namespace {

SettingOutcome of_picture(SettingKind kind, const std::string& name, double ms, double error) {
  SettingOutcome outcome;
  outcome.setting.kind = kind;
  outcome.setting.name = name;
  outcome.p50_ms = ms;
  outcome.p99_ms = 1.5 * ms;
  outcome.error = error;
  outcome.doubt = 2.0 * error;
  return outcome;
}

AccuracyReport some_report() {
  QuestionReport all;
  all.question = "all";
  all.outcomes = {of_picture(SettingKind::KERNEL, "robust", 1.0, 1e-17),
                  of_picture(SettingKind::KERNEL, "exact", 1.2, 0.0),
                  of_picture(SettingKind::DEADLINE, "deadline at 25 %", 0.3,
                             std::numeric_limits<double>::infinity()),
                  of_picture(SettingKind::ENGINE, "engine brute_force", 9.0, 1e-17)};
  all.dominated = {false, true, false, true};
  QuestionReport closest = all;
  closest.question = "closest";
  closest.outcomes.push_back(of_picture(SettingKind::TOLERANCE, "tolerance of 1 mm", 0.7, 1e-3));
  closest.dominated.push_back(false);
  AccuracyReport report;
  report.file = "/somewhere/a<b>&\"c\".csv";
  report.margin = 0.01;
  report.track.noise = 2e-3;
  report.frame_time = 0.033;
  report.questions = {all, closest};
  return report;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++found;
  }
  return found;
}

TEST(AccuracyPicture, HasEverySettingAndBothLines) {
  const std::string picture = picture_of(some_report());
  for (const char* name : {"robust", "exact", "deadline at 25 %", "engine brute_force"}) {
    EXPECT_EQ(count(picture, std::string("<title>") + name + ':'), 2U) << "a mark in each panel";
    EXPECT_EQ(count(picture, std::string(">") + name + "</text>"),
              std::string(name) == "exact" ? 3U : 1U)
        << "in the legend; exact at the edge of each panel as well";
  }
  EXPECT_EQ(count(picture, "<title>tolerance of 1 mm:"), 1U);
  EXPECT_EQ(count(picture, "tracker's noise 2 mm"), 2U);
  EXPECT_EQ(count(picture, "next frame"), 2U);
  EXPECT_EQ(count(picture, "opacity=\"0.25\""), 4U) << "what is dominated";
  EXPECT_NE(picture.find("a&lt;b&gt;&amp;\"c\".csv"), std::string::npos);
  EXPECT_EQ(picture.find("nan"), std::string::npos);
  EXPECT_EQ(picture.find("=\"inf"), std::string::npos);
}

TEST(AccuracyPicture, ASettingHasOneColour) {
  const std::string picture = picture_of(some_report());
  // Its line in each panel, its mark there and in the legend.
  EXPECT_EQ(count(picture, "#8c1d18") % 2, 1U);
  AccuracyReport report = some_report();
  std::swap(report.questions[0], report.questions[1]);
  EXPECT_EQ(count(picture_of(report), "#8c1d18"), count(picture, "#8c1d18"));
}

TEST(AccuracyPicture, WithoutNoiseAndRateThereAreNoLines) {
  AccuracyReport report = some_report();
  report.track.noise.reset();
  report.frame_time.reset();
  const std::string picture = picture_of(report);
  EXPECT_EQ(picture.find("noise"), std::string::npos);
  EXPECT_EQ(picture.find("next frame"), std::string::npos);
}

TEST(NumberText, IsShortAndWithoutExponents) {
  EXPECT_EQ(rounded_text(0.0123456), "0.012");
  EXPECT_EQ(rounded_text(99.7), "100");
  EXPECT_EQ(rounded_text(99.7, 3), "99.7");
  EXPECT_EQ(rounded_text(12345.6), "12346");
  EXPECT_EQ(rounded_text(-123.4), "-123");
  EXPECT_EQ(rounded_text(0.0), "0");
  EXPECT_EQ(millimetres(1e-5), "0.01 mm");
  EXPECT_EQ(millimetres(0.35), "350 mm");
}

}  // namespace
}  // namespace fiber::test

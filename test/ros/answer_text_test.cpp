// What the node's text says of an answer.
#include "src/ros/outputs/answer_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace fiber_proximity_ros {
namespace {

using fiber::QueryType;

/// Contacts of fibres that were found, and a closest pair of 27.7 mm, all of it known.
PairsAnswer pairs(QueryType type, std::size_t contacts) {
  PairsAnswer answer;
  answer.asked.type = type;
  answer.asked.margin = 0.03;
  answer.contacts = contacts;
  answer.contact_error = 3.72e-17;
  answer.others_lower = 0.03;
  answer.minimum = 0.0277;
  answer.minimum_lower = 0.0277;
  answer.minimum_upper = 0.0277;
  return answer;
}

/// The text without its last line, which is about time.
std::string text_of(const PairsAnswer& pairs) {
  Answer answer;
  answer.fibers = pairs;
  const std::string text = answer_text(answer);
  return text.substr(0, text.find('\n'));
}

TEST(AnswerText, TellsOfAllContactsHowManyAndWhetherThatIsAll) {
  PairsAnswer all = pairs(QueryType::ALL, 18);
  EXPECT_EQ(text_of(all),
            "robust: 18 of 18 contacts (each to 3.8e-17 m), closest 27.7 mm (to 0 mm)");
  all.is_cut_off = true;
  all.minimum_lower = -0.01;
  all.contacts = 3;
  EXPECT_EQ(text_of(all),
            "robust: at least 3 contacts (each to 3.8e-17 m), cut off, closest 27.7 mm, true >= "
            "-10.0 mm");
  all.contacts = 0;
  EXPECT_EQ(text_of(all),
            "robust: at least 0 contacts, cut off, closest 27.7 mm, true >= -10.0 mm");
  all.is_cut_off = false;
  all.minimum_lower = 0.0277;
  EXPECT_EQ(text_of(all), "robust: no contact within 30.0 mm, closest 27.7 mm (to 0 mm)");
  all.contacts = 500;
  all.limit_reached = true;
  all.others_lower = 0.012345;
  EXPECT_EQ(text_of(all),
            "robust: the closest 500 contacts (each to 3.8e-17 m), any other >= 12.3 mm, "
            "closest 27.7 mm (to 0 mm)");
  all.asked.kernel = fiber::Kernel::EXACT;
  all.limit_reached = false;
  all.asked.tolerance = 0.02;  // which is not about all contacts
  EXPECT_EQ(text_of(all),
            "exact: 500 of 500 contacts (each to 3.8e-17 m), closest 27.7 mm (to 0 mm)");
}

TEST(AnswerText, TellsOfTheClosestPairItsDistanceAndWhatIsProven) {
  PairsAnswer closest = pairs(QueryType::CLOSEST, 1);
  EXPECT_EQ(text_of(closest), "robust: closest 27.7 mm (to 0 mm)");
  closest.minimum_lower = std::nextafter(0.0277, 0.0);
  EXPECT_EQ(text_of(closest), "robust: closest 27.7 mm (to 3.5e-18 m)");
  closest.minimum_lower = 0.0077;
  EXPECT_EQ(text_of(closest), "robust: closest 27.7 mm, true >= 7.70 mm");
  closest.minimum_lower = 0.00779;
  EXPECT_EQ(text_of(closest), "robust: closest 27.7 mm, true >= 7.79 mm");
  closest.minimum_lower = 0.007799;
  EXPECT_EQ(text_of(closest), "robust: closest 27.7 mm, true >= 7.79 mm") << "rounded down";
  closest.minimum_upper = 0.0291;
  EXPECT_EQ(text_of(closest), "robust: closest 27.7 mm, true 7.79 mm to 29.1 mm");
  closest.contacts = 0;
  EXPECT_EQ(text_of(closest),
            "robust: no contact within 30.0 mm, closest 27.7 mm, true 7.79 mm to 29.1 mm");
  closest.minimum.reset();
  closest.minimum_lower = 0.03;
  EXPECT_EQ(text_of(closest), "robust: no contact within 30.0 mm, closest true >= 30.0 mm");
  closest.minimum_lower = HUGE_VAL;
  closest.asked.margin = 0.0;
  EXPECT_EQ(text_of(closest), "robust: no contact, no pair");
  closest.is_cut_off = true;
  closest.minimum_lower = -0.01;
  EXPECT_EQ(text_of(closest), "robust: no contact found, cut off, closest true >= -10.0 mm");
}

TEST(AnswerText, TellsPenetrationByItsDepth) {
  PairsAnswer closest = pairs(QueryType::CLOSEST, 1);
  closest.minimum = closest.minimum_lower = closest.minimum_upper = -0.00203;
  EXPECT_EQ(text_of(closest), "robust: penetration 2.03 mm (to 0 mm)");
  closest.minimum_lower = -0.005101;
  EXPECT_EQ(text_of(closest), "robust: penetration 2.03 mm, true <= 5.11 mm") << "rounded up";
  closest.was_all_there = false;
  closest.minimum_lower = -HUGE_VAL;
  EXPECT_EQ(text_of(closest), "robust: penetration known 2.03 mm, true may be deeper");
  closest.minimum = 0.0;
  EXPECT_EQ(text_of(closest), "robust: closest known 0 mm, true may be closer");
}

TEST(AnswerText, TellsOfTheFirstOnlyThatItIsThere) {
  PairsAnswer first = pairs(QueryType::FIRST, 1);
  EXPECT_EQ(text_of(first), "robust: in contact, closest 27.7 mm (to 0 mm)");
  first.minimum.reset();
  first.minimum_lower = -0.01;
  EXPECT_EQ(text_of(first), "robust: in contact");
  first.is_cut_off = true;
  EXPECT_EQ(text_of(first), "robust: in contact");
  first.contacts = 0;
  EXPECT_EQ(text_of(first), "robust: no contact within 30.0 mm found, cut off");
  first.was_all_there = false;
  first.minimum_lower = -HUGE_VAL;
  EXPECT_EQ(text_of(first), "robust: no contact within 30.0 mm found, cut off, of what is known");
  first.is_cut_off = false;
  EXPECT_EQ(text_of(first), "robust: no contact within 30.0 mm found, of what is known");
}

TEST(AnswerText, TellsOfLimitedWhatTheOthersAreBeyond) {
  PairsAnswer limited = pairs(QueryType::LIMITED, 4);
  limited.asked.tolerance = 0.02;
  EXPECT_EQ(text_of(limited),
            "robust: 4 of 4 contacts (each to 3.8e-17 m), closest 27.7 mm (to 0 mm)");
  limited.limit_reached = true;
  limited.others_lower = 0.0091;
  EXPECT_EQ(text_of(limited),
            "robust: the closest 4 contacts (each to 3.8e-17 m), any other >= 9.10 mm, "
            "closest 27.7 mm (to 0 mm)");
  limited.is_cut_off = true;
  EXPECT_EQ(text_of(limited),
            "robust: at least 4 contacts (each to 3.8e-17 m), cut off, closest 27.7 mm (to 0 mm)");
}

TEST(AnswerText, TellsOfPairsOfBodiesHowMuchCloserEachMayBe) {
  PairsAnswer of_fibers = pairs(QueryType::FIBER_PAIRS, 5);
  EXPECT_EQ(text_of(of_fibers),
            "robust: 5 of 5 pairs of bodies (each to 3.8e-17 m), closest 27.7 mm (to 0 mm)");
  of_fibers.asked.tolerance = 0.02;
  of_fibers.minimum_lower = 0.0077;
  EXPECT_EQ(text_of(of_fibers),
            "robust: 5 of 5 pairs of bodies (each to 3.8e-17 m), each may be closer by 20.0 mm, "
            "closest 27.7 mm, true >= 7.70 mm");
  of_fibers.asked.relative_tolerance = 0.1;
  of_fibers.is_cut_off = true;
  EXPECT_EQ(text_of(of_fibers),
            "robust: at least 5 pairs of bodies (each to 3.8e-17 m), cut off, "
            "closest 27.7 mm, true >= 7.70 mm")
      << "those that were found may be closer by any length";
}

TEST(AnswerText, OfWhatIsUnknownNothingIsToldAsComplete) {
  for (const QueryType type : {QueryType::FIRST, QueryType::CLOSEST, QueryType::LIMITED,
                               QueryType::ALL, QueryType::FIBER_PAIRS}) {
    for (const std::size_t contacts : {0U, 3U}) {
      PairsAnswer answer = pairs(type, contacts);
      answer.was_all_there = false;
      answer.minimum_lower = -HUGE_VAL;
      const std::string text = text_of(answer);
      EXPECT_EQ(text.find(" of 3"), std::string::npos) << text;
      EXPECT_EQ(text.find("(to"), std::string::npos) << text;
      EXPECT_EQ(text.find("no contact,"), std::string::npos) << text;
      EXPECT_NE(text.find("closest known 27.7 mm, true may be closer"), std::string::npos) << text;
    }
  }
  PairsAnswer answer = pairs(QueryType::ALL, 0);
  answer.was_all_there = false;
  answer.minimum.reset();
  answer.minimum_lower = -HUGE_VAL;
  EXPECT_EQ(text_of(answer), "robust: at least 0 contacts, of what is known, closest unknown");
  answer.has_failed = true;
  EXPECT_EQ(text_of(answer), "robust: no answer");
}

TEST(AnswerText, RoundsBoundsOutwardsWhateverTheirSize) {
  PairsAnswer answer = pairs(QueryType::CLOSEST, 1);
  for (double scale = 1e-12; scale < 1e12; scale *= 10.0) {
    for (const double digits : {1.0, 1.234567, 9.99999, 5.0, 7.7, 3.1415}) {
      for (const double sign : {-1.0, 1.0}) {
        const double lower = sign * digits * scale;
        answer.minimum = lower + 100.0 * scale;
        answer.minimum_upper = *answer.minimum;
        answer.minimum_lower = lower;
        std::string text = text_of(answer);
        const std::size_t at = text.find("true >= ");
        if (at == std::string::npos) {  // less than can be seen
          EXPECT_LT(100.0 * scale, 1.01e-6) << text;
          continue;
        }
        const double number = std::stod(text.substr(at + 8));
        const double told = text.find("mm", at) != std::string::npos ? number / 1000.0 : number;
        EXPECT_LE(told, lower) << text;
        EXPECT_NEAR(told, lower, 0.1 * std::abs(lower)) << text;
      }
    }
  }
}

TEST(AnswerText, TellsTheTimeOfTheWholeAnswerAndOfItsParts) {
  Answer answer;
  answer.fibers = pairs(QueryType::ALL, 0);
  answer.objects = pairs(QueryType::ALL, 2);
  answer.objects->minimum = answer.objects->minimum_lower = answer.objects->minimum_upper = 0.0;
  answer.parts = {{"merge", 1e-6, true}, {"contacts", 0.0001, true}, {"prediction", 1e-6, false}};
  answer.total_time = 0.00035;
  const std::string pairs =
      "robust: no contact within 30.0 mm, closest 27.7 mm (to 0 mm)\n"
      "objects: 2 of 2 contacts (each to 3.8e-17 m), closest 0 mm (to 0 mm)\n";
  EXPECT_EQ(answer_text(answer),
            pairs + "0.35 ms: contacts 0.10, prediction 0.00 (incomplete), others 0.25");
  answer.goes_on = true;
  EXPECT_EQ(answer_text(answer),
            pairs + "0.35 ms so far: contacts 0.10, prediction 0.00 (incomplete), others 0.25");
  answer.goes_on = false;
  answer.deadline = 0.0005;
  EXPECT_EQ(answer_text(answer),
            pairs + "0.35 of 0.50 ms: contacts 0.10, prediction 0.00 (incomplete), others 0.25");
  answer.parts[0].seconds = 0.00051;
  answer.total_time = 0.0009;
  EXPECT_EQ(answer_text(answer),
            pairs +
                "0.90 of 0.50 ms: merge 0.51, contacts 0.10, prediction 0.00 (incomplete), "
                "others 0.29; updates alone take longer");
}

TEST(AnswerText, TellsWhichContactsOfUncertainInputsAreCertain) {
  PairsAnswer answer = pairs(QueryType::ALL, 18);
  answer.uncertain = 6;
  answer.contact_error = 0.004;
  answer.minimum_lower = 0.0237;
  answer.minimum_upper = 0.0317;
  EXPECT_EQ(text_of(answer),
            "robust: 18 possible contacts, 12 of them certain (each to 4.00 mm), closest 27.7 mm, "
            "true 23.7 mm to 31.7 mm");
  answer.is_cut_off = true;
  EXPECT_EQ(text_of(answer),
            "robust: at least 18 possible contacts, 12 of them certain (each to 4.00 mm), cut off, "
            "closest 27.7 mm, true 23.7 mm to 31.7 mm");
  answer.is_cut_off = false;
  answer.asked.type = QueryType::FIRST;
  EXPECT_EQ(text_of(answer).substr(0, 27), "robust: perhaps in contact,");
}

}  // namespace
}  // namespace fiber_proximity_ros

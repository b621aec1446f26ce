#include "src/rviz/answer_history.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace fiber_proximity_rviz {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

fiber_proximity::Statistics answer_of(double lower, double upper, double contact_error) {
  fiber_proximity::Statistics answer;
  answer.complete = 1;
  answer.minimum_lower = lower;
  answer.minimum_upper = upper;
  answer.contact_error = contact_error;
  return answer;
}

TEST(ProvenUncertainty, IsTheWiderOfTheMinimumsBoundsAndTheContacts) {
  EXPECT_DOUBLE_EQ(proven_uncertainty(answer_of(0.0077, 0.0277, 1e-17)), 0.02);
  EXPECT_EQ(proven_uncertainty(answer_of(0.1, 0.1, 1e-9)), 1e-9);
  EXPECT_EQ(proven_uncertainty(answer_of(infinity, infinity, 0.0)), 0.0) << "no pair";
}

TEST(ProvenUncertainty, OfWhatIsNotKnownIsInfinite) {
  EXPECT_EQ(proven_uncertainty(answer_of(-infinity, 0.1, 0.0)), infinity);
  fiber_proximity::Statistics cut_off = answer_of(0.1, 0.1, 0.0);
  cut_off.complete = 0;
  EXPECT_EQ(proven_uncertainty(cut_off), infinity);
}

TEST(AnswerHistory, KeepsPartsApartAndForgetsWhatIsOld) {
  AnswerHistory history(30.0);
  fiber_proximity::Statistics answer = answer_of(0.1, 0.1, 0.0);
  answer.total_time = 0.004;
  answer.parts = {"merge", "contacts"};
  answer.part_times = {0.001, 0.002};
  history.add(100.0, answer);
  answer.parts = {"contacts", "motion"};
  history.add(101.0, answer);
  history.mark(100.5, "kernel: exact");
  EXPECT_EQ(history.parts(), (std::vector<std::string>{"merge", "contacts", "motion"}));
  ASSERT_EQ(history.answers().size(), 2U);
  EXPECT_EQ(history.answers()[0].part_times, (std::vector<double>{0.001, 0.002}));
  EXPECT_EQ(history.answers()[1].part_times, (std::vector<double>{0.0, 0.001, 0.002}));
  EXPECT_EQ(history.answers()[1].total, 0.004);
  history.forget(130.8);
  EXPECT_EQ(history.answers().size(), 1U);
  EXPECT_TRUE(history.marks().empty());
}

}  // namespace
}  // namespace fiber_proximity_rviz

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <stdexcept>

#include "benchmark/kernels/pair_kernel.hpp"
#include "benchmark/kernels/pair_score.hpp"
#include "benchmark/kernels/pair_times.hpp"
#include "benchmark/kernels/textbook.hpp"
#include "test/support/not_finite.hpp"

namespace fiber::test {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// Parallel segments of 4 m at a distance, 3 m, and radii of 1 m and 1 m + `more`.
HardPair parallel_pair(double more) {
  return {{0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {4, 3, 0}, 1.0, 2.0 + more};
}

Guarded<PairAnswer> answered(double distance, bool contact, double lower = -infinity,
                             double upper = infinity) {
  return {Outcome::ANSWERED, {distance, lower, upper, contact}};
}

PairScore score_of(const HardPair& pair, const Guarded<PairAnswer>& answer) {
  PairScore score;
  score.add(pair, PairTruth(pair), answer);
  return score;
}

TEST(PairTruth, KnowsDistanceUnitAndContact) {
  const PairTruth truth(parallel_pair(0.0));
  EXPECT_EQ(truth.distance, 3.0);
  EXPECT_EQ(truth.unit, 4.0 * epsilon);
  EXPECT_TRUE(truth.contact) << "touching is a contact";
  EXPECT_FALSE(PairTruth(parallel_pair(-2.0 * epsilon)).contact);
  const HardPair point{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}, 0.0, 0.0};
  EXPECT_EQ(PairTruth(point).unit, std::numeric_limits<double>::denorm_min());
}

TEST(PairScore, KeepsTheWorstError) {
  const HardPair pair = parallel_pair(0.0);
  const PairTruth truth(pair);
  PairScore score;
  score.add(pair, truth, answered(3.25, false));
  score.add(pair, truth, answered(2.5, true));
  score.add(pair, truth, answered(3.0, true));
  EXPECT_EQ(score.answered(), 3U);
  EXPECT_EQ(score.error(), 0.5);
  EXPECT_EQ(score.error_units(), 0.125 / epsilon);
  EXPECT_EQ(score.relative_error(), 0.5 / 3.0);
}

TEST(PairScore, HasNoRelativeErrorWhereTheDistanceIsNone) {
  const HardPair crossing{{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, 0.0, 0.0};
  const PairScore score = score_of(crossing, answered(0.25, false));
  EXPECT_EQ(score.error(), 0.25);
  EXPECT_EQ(score.relative_error(), 0.0);
}

TEST(PairScore, TellsTheKernelsDecisionFromThatOfItsDistance) {
  const HardPair touching = parallel_pair(0.0);
  const PairScore missed = score_of(touching, answered(2.0, false));
  EXPECT_EQ(missed.missed_contacts(), 1U);
  EXPECT_EQ(missed.plain_missed_contacts(), 0U);
  const PairScore plain_missed = score_of(touching, answered(4.0, true));
  EXPECT_EQ(plain_missed.missed_contacts(), 0U);
  EXPECT_EQ(plain_missed.plain_missed_contacts(), 1U);

  const HardPair apart = parallel_pair(-0.5);
  const PairScore false_contact = score_of(apart, answered(3.0, true));
  EXPECT_EQ(false_contact.false_contacts(), 1U);
  EXPECT_EQ(false_contact.plain_false_contacts(), 0U);
  const PairScore plain_false = score_of(apart, answered(2.0, false));
  EXPECT_EQ(plain_false.false_contacts(), 0U);
  EXPECT_EQ(plain_false.plain_false_contacts(), 1U);

  for (const PairScore& score : {missed, plain_missed}) {
    EXPECT_EQ(score.false_contacts() + score.plain_false_contacts(), 0U);
  }
  for (const PairScore& score : {false_contact, plain_false}) {
    EXPECT_EQ(score.missed_contacts() + score.plain_missed_contacts(), 0U);
  }
}

TEST(PairScore, CountsBoundsThatMissTheTruth) {
  const HardPair pair = parallel_pair(0.0);
  const double below = std::nextafter(3.0, 0.0);
  const double above = std::nextafter(3.0, 4.0);
  EXPECT_EQ(score_of(pair, answered(3.0, true)).outside_bounds(), 0U) << "none are stated";
  EXPECT_EQ(score_of(pair, answered(3.0, true, 3.0, 3.0)).outside_bounds(), 0U);
  EXPECT_EQ(score_of(pair, answered(3.0, true, below, above)).outside_bounds(), 0U);
  EXPECT_EQ(score_of(pair, answered(3.0, true, above, 4.0)).outside_bounds(), 1U);
  EXPECT_EQ(score_of(pair, answered(3.0, true, 0.0, below)).outside_bounds(), 1U);
}

TEST(PairScore, CountsEachKindOfNoAnswerAndNothingElseOfIt) {
  const HardPair pair = parallel_pair(0.0);
  const PairTruth truth(pair);
  PairScore score;
  score.add(pair, truth, {Outcome::NOT_FINITE, {}});
  score.add(pair, truth, {Outcome::NO_ANSWER, {}});
  score.add(pair, truth, {Outcome::NO_ANSWER, {}});
  score.add(pair, truth, {Outcome::ENDED, {}});
  EXPECT_EQ(score.not_finite(), 1U);
  EXPECT_EQ(score.no_answer(), 2U);
  EXPECT_EQ(score.ended(), 1U);
  EXPECT_EQ(score.answered(), 0U);
  EXPECT_EQ(score.missed_contacts() + score.plain_missed_contacts() + score.outside_bounds(), 0U);
  EXPECT_EQ(score.error_units(), 0.0);
}

/// Does to every pair what its index says.
class Failing final : public PairKernel {
 public:
  void prepare(const std::vector<HardPair>& /*pairs*/) override {}
  void run(std::size_t /*first*/, std::size_t /*count*/, double* /*distances*/) override {}
  PairAnswer answer(std::size_t index) override {
    switch (index) {
      case 1:
        std::abort();
      case 2:
        throw std::runtime_error("no convergence");
      case 3:
        return {};
      case 4:
        for (volatile int i = 0;; i = i ^ 1) {
        }
      default:
        return {static_cast<double>(index), -infinity, infinity, true};
    }
  }
};

TEST(GuardedAnswers, SurviveWhatAKernelDoes) {
  Failing kernel;
  const std::vector<Guarded<PairAnswer>> answers = guarded_answers(kernel, 7);
  const std::vector<Outcome> expected{Outcome::ANSWERED,   Outcome::ENDED, Outcome::NO_ANSWER,
                                      Outcome::NOT_FINITE, Outcome::ENDED, Outcome::ANSWERED,
                                      Outcome::ANSWERED};
  ASSERT_EQ(answers.size(), expected.size());
  for (std::size_t i = 0; i < answers.size(); ++i) {
    EXPECT_EQ(answers[i].outcome, expected[i]) << i;
  }
  EXPECT_EQ(answers[6].answer.distance, 6.0);
  EXPECT_TRUE(answers[6].answer.contact);
}

/// Ends the process when it is asked about the pair with this radius.
class Aborting final : public PairKernel {
 public:
  void prepare(const std::vector<HardPair>& pairs) override { pairs_ = &pairs; }
  void run(std::size_t first, std::size_t count, double* distances) override {
    for (std::size_t i = 0; i < count; ++i) {
      if ((*pairs_)[first + i].radius_a == fatal) {
        std::abort();
      }
      distances[i] = 1.0;
    }
  }
  PairAnswer answer(std::size_t /*index*/) override { return {}; }

  static constexpr double fatal = 7.0;

 private:
  const std::vector<HardPair>* pairs_ = nullptr;
};

TEST(PairTimes, AreThoseOfEveryBlock) {
  Aborting kernel;
  Aborting idle;
  const std::vector<HardPair> pairs(70);
  const auto times = pair_times_ns({{&kernel, pairs}, {&idle, {}}}, 3);
  ASSERT_EQ(times.size(), 2U);
  EXPECT_EQ(times[0].size(), 3U) << "32, 32 and 6 pairs";
  EXPECT_TRUE(times[1].empty());
}

TEST(PairTimes, LeaveOutPairsThatEndTheProcess) {
  Aborting one;
  Aborting other;
  std::vector<HardPair> pairs(33);
  const std::vector<HardPair> harmless = pairs;
  pairs[20].radius_a = Aborting::fatal;
  const auto times = pair_times_ns({{&one, pairs}, {&other, harmless}}, 3);
  ASSERT_EQ(times.size(), 2U);
  EXPECT_EQ(times[0].size(), 1U) << "32 are left";
  EXPECT_EQ(times[1].size(), 2U);
}

TEST(Textbook, HasTheDistanceOfEveryKindOfOptimum) {
  using Eigen::Vector3d;
  const auto of = [](const Vector3d& p0, const Vector3d& p1, const Vector3d& q0,
                     const Vector3d& q1) { return textbook_distance(p0, p1, q0, q1); };
  EXPECT_EQ(of({-1, 0, 0}, {1, 0, 0}, {0, -1, 2}, {0, 1, 2}), 2.0) << "inside both";
  EXPECT_EQ(of({-1, 0, 0}, {1, 0, 0}, {0, 3, 0}, {0, 5, 0}), 3.0) << "q0, inside p";
  EXPECT_EQ(of({-1, 0, 0}, {1, 0, 0}, {0, -5, 0}, {0, -3, 0}), 3.0) << "q1, inside p";
  EXPECT_EQ(of({0, 3, 0}, {0, 5, 0}, {-1, 0, 0}, {1, 0, 0}), 3.0) << "p0, inside q";
  EXPECT_EQ(of({0, 0, 0}, {1, 0, 0}, {4, 4, 0}, {9, 9, 0}), 5.0) << "two ends";
  EXPECT_EQ(of({0, 0, 0}, {4, 0, 0}, {1, 3, 0}, {9, 3, 0}), 3.0) << "parallel";
  EXPECT_EQ(of({1, 1, 1}, {1, 1, 1}, {1, 1, 3}, {1, 1, 3}), 2.0) << "points";
  EXPECT_EQ(of({0, 2, 0}, {0, 2, 0}, {-1, 0, 0}, {1, 0, 0}), 2.0) << "a point and a segment";
  EXPECT_EQ(of({-1, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 2, 0}), 2.0) << "a segment and a point";
}

/// Whoever turns axes or adds radii wrongly compares with nothing.
TEST(PairKernels, AgreeOnEasyPairs) {
  const HardFamily& generic = hard_families().front();
  const std::vector<HardPair> pairs = hard_pairs(generic, 50, 1);
  for (const std::string& name : pair_kernel_names()) {
    SCOPED_TRACE(name);
    const std::unique_ptr<PairKernel> kernel = make_pair_kernel(name);
    kernel->prepare(pairs);
    const std::vector<Guarded<PairAnswer>> answers = guarded_answers(*kernel, pairs.size());
    std::size_t answered = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (answers[i].outcome == Outcome::ANSWERED) {
        ++answered;
        // FCL's GJK ends at 1e-6.
        EXPECT_NEAR(answers[i].answer.distance, PairTruth(pairs[i]).distance, 1e-5) << i;
      }
    }
    EXPECT_GT(answered, pairs.size() / 2);
  }
}

TEST(PairKernels, OfOursKeepTheirBoundsAndMissNoContact) {
  for (const std::string name : {"robust", "robust_batch", "exact"}) {
    SCOPED_TRACE(name);
    const std::unique_ptr<PairKernel> kernel = make_pair_kernel(name);
    PairScore score;
    for (const HardFamily& family : hard_families()) {
      const std::vector<HardPair> pairs = hard_pairs(family, 5, 1);
      kernel->prepare(pairs);
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        score.add(pairs[i], PairTruth(pairs[i]), {Outcome::ANSWERED, kernel->answer(i)});
      }
    }
    EXPECT_EQ(score.missed_contacts(), 0U);
    EXPECT_EQ(score.outside_bounds(), 0U);
    EXPECT_EQ(score.false_contacts(), 0U);
  }
}

}  // namespace
}  // namespace fiber::test

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

#include "benchmark/continuous/motion_accuracy.hpp"
#include "benchmark/kernels/decision_score.hpp"
#include "benchmark/kernels/motion_kernel.hpp"
#include "benchmark/kernels/motion_times.hpp"

namespace fiber::test {
namespace {

const MotionFamily& motion_family(const std::string& name) {
  return *std::find_if(motion_families().begin(), motion_families().end(),
                       [&](const MotionFamily& family) { return family.name == name; });
}

/// Two spheres with radii of 1 m whose centres are `gap` + 2 m apart, of which one goes straight to
/// the other's place. They touch after gap / (gap + 2) of the motion.
HardMotion meeting_spheres(double gap) {
  HardMotion motion;
  for (int end = 0; end < 2; ++end) {
    motion.a_before[end] = {gap + 2.0, 0.0, 0.0};
    motion.a_after[end] = motion.b_before[end] = motion.b_after[end] = Eigen::Vector3d::Zero();
  }
  motion.radius_a = motion.radius_b = 1.0;
  return motion;
}

/// As they, but past each other with this gap.
HardMotion passing_spheres(double gap) {
  HardMotion motion = meeting_spheres(2.0);
  for (int end = 0; end < 2; ++end) {
    motion.a_before[end] = {4.0, gap + 2.0, 0.0};
    motion.a_after[end] = {-4.0, gap + 2.0, 0.0};
  }
  return motion;
}

MotionScore accuracy_of(const std::string& family, const AnswerMotion& answer) {
  return motion_accuracy(motion_family(family), {200, 1}, {1e-6}, 2, answer).at(0).score;
}

TEST(MotionAccuracy, NoticesAKernelThatNeverSeesAContact) {
  const AnswerMotion never = [](const SegmentMotions&, double) { return ContactTime(); };
  for (const std::string family : {"random", "grazing, translating", "touching before"}) {
    const MotionScore own = accuracy_of(family, contact_time);
    const MotionScore missed = accuracy_of(family, never);
    EXPECT_GT(own.certain, 0U) << family;
    // Some contacts are less deep than the truth can tell.
    EXPECT_GT(2 * missed.misses, own.certain) << family;
    EXPECT_GE(missed.misses + missed.undecided, own.certain) << family;
    EXPECT_LE(missed.misses, own.hits) << family;
  }
}

TEST(MotionAccuracy, NoticesAKernelThatAlwaysSeesAContact) {
  const AnswerMotion always = [](const SegmentMotions&, double) {
    return ContactTime{true, 0.0, 1.0, true};
  };
  const MotionScore score = accuracy_of("random", always);
  EXPECT_EQ(score.hits, 200U);
  EXPECT_EQ(score.misses, 0U);
  EXPECT_GT(score.false_alarms, 100U);
  EXPECT_GE(score.wrongly_certain, score.false_alarms);
}

TEST(MotionAccuracy, NoticesAKernelThatIsLate) {
  const AnswerMotion late = [](const SegmentMotions& motions, double tolerance) {
    ContactTime answer = contact_time(motions, tolerance);
    answer.lower = answer.hit ? std::min(1.0, answer.lower + 1e-3) : answer.lower;
    answer.upper = std::max(answer.lower, answer.upper);
    return answer;
  };
  const MotionScore score = accuracy_of("random", late);
  EXPECT_GT(score.misses, 0U);
  EXPECT_LE(score.misses, score.hits);
}

TEST(MotionAccuracy, KeepsSomeOfTheWrongAnswers) {
  const AnswerMotion never = [](const SegmentMotions&, double) { return ContactTime(); };
  const MotionAccuracy found =
      motion_accuracy(motion_family("coincident"), {200, 1}, {1e-6}, 2, never).at(0);
  EXPECT_GT(found.score.misses, 5U);
  ASSERT_EQ(found.wrong.size(), 5U);
  for (const auto& [motion, tolerance, answer] : found.wrong) {
    EXPECT_EQ(judge(motion, tolerance, answer).misses, 1U);
  }
}

TEST(MotionAccuracy, IsTheSameOnAnyNumberOfThreads) {
  const MotionFamily& family = motion_family("grazing points");
  const auto one = motion_accuracy(family, {250, 3}, {1e-3, 1e-9}, 1, contact_time);
  const auto three = motion_accuracy(family, {250, 3}, {1e-3, 1e-9}, 3, contact_time);
  ASSERT_EQ(one.size(), 2U);
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].score.motions, 250U);
    EXPECT_EQ(one[i].score.hits, three[i].score.hits);
    EXPECT_EQ(one[i].score.certain, three[i].score.certain);
  }
  EXPECT_NE(one[0].score.hits, one[1].score.hits) << "a tolerance makes near ones hits";
}

TEST(MotionTruth, TellsContactsFromWhatOnlyComesNear) {
  const auto expect = [](const HardMotion& motion, bool contact, bool near) {
    const MotionTruth truth(motion, 1e-6);
    EXPECT_EQ(truth.contact, contact);
    EXPECT_EQ(truth.near, near);
    EXPECT_FALSE(truth.undecided);
  };
  expect(meeting_spheres(1.0), true, true);
  expect(passing_spheres(-0.5), true, true);
  expect(passing_spheres(0.5e-6), false, true);
  expect(passing_spheres(2e-6), false, false);
  const HardMotion crossing = hard_motions(motion_family("crossing"), 1, 1).front();
  expect(crossing, true, true);
}

DecisionScore decision(const HardMotion& motion, const ContactTime& time) {
  DecisionScore score;
  score.add(motion, MotionTruth(motion, 1e-6), {Outcome::ANSWERED, time});
  EXPECT_EQ(score.answered, 1U);
  return score;
}

TEST(DecisionScore, CountsWrongDecisions) {
  EXPECT_EQ(decision(meeting_spheres(2.0), ContactTime()).misses, 1U);
  EXPECT_EQ(decision(meeting_spheres(2.0), ContactTime()).start_misses, 0U);
  EXPECT_EQ(decision(meeting_spheres(0.0), ContactTime()).start_misses, 1U);
  EXPECT_EQ(decision(passing_spheres(1.0), {true, 0.4, 0.5, false}).false_alarms, 1U);
  EXPECT_EQ(decision(passing_spheres(0.5e-6), {true, 0.4, 0.5, false}).false_alarms, 0U);
  EXPECT_EQ(decision(passing_spheres(0.5e-6), ContactTime()).misses, 0U);
}

TEST(DecisionScore, CountsWrongTimesOfRightDecisions) {
  const HardMotion motion = meeting_spheres(2.0);  // touch at 0.5
  const DecisionScore right = decision(motion, {true, 0.5 - 1e-9, 0.5 + 1e-9, false});
  EXPECT_EQ(right.late + right.early + right.misses + right.false_alarms, 0U);
  EXPECT_EQ(decision(motion, {true, 0.6, 0.7, false}).late, 1U);
  EXPECT_EQ(decision(motion, {true, 0.3, 0.4, false}).early, 1U);
}

TEST(DecisionScore, CountsWhatIsNoAnswerAndNothingElseOfIt) {
  const HardMotion motion = meeting_spheres(2.0);
  const MotionTruth truth(motion, 1e-6);
  DecisionScore score;
  score.add(motion, truth, Guarded<ContactTime>());
  score.add(motion, truth, {Outcome::NO_ANSWER, {}});
  score.add(motion, truth, {Outcome::NOT_FINITE, {}});
  EXPECT_EQ(score.ended, 1U);
  EXPECT_EQ(score.no_answer, 2U);
  EXPECT_EQ(score.answered + score.misses, 0U);
}

/// Does to every motion what the radius of its first capsule says; otherwise never sees a contact.
class FailingMotions final : public MotionKernel {
 public:
  static constexpr double unknown = 2.0;
  static constexpr double fatal = 3.0;
  static constexpr double endless = 4.0;
  static constexpr double throwing = 5.0;
  static constexpr double timeless = 6.0;

  bool can_answer(const HardMotion& motion) const override { return motion.radius_a != unknown; }

  void prepare(const std::vector<HardMotion>& motions) override { motions_ = &motions; }

  void run(std::size_t first, std::size_t count, ContactTime* times) override {
    for (std::size_t i = 0; i < count; ++i) {
      const double radius = (*motions_)[first + i].radius_a;
      times[i] = ContactTime();
      if (radius == fatal) {
        std::abort();
      }
      for (volatile int turn = 0; radius == endless; turn = turn ^ 1) {
      }
      if (radius == throwing) {
        throw std::runtime_error("no convergence");
      }
      if (radius == timeless) {
        times[i] = {true, 0.0, std::nan(""), false};
      }
    }
  }

 private:
  const std::vector<HardMotion>* motions_ = nullptr;
};

TEST(MotionKernelResults, SurviveWhatAKernelDoes) {
  std::vector<HardMotion> motions(8, meeting_spheres(2.0));
  for (std::size_t i = 1; i <= 5; ++i) {
    motions[i].radius_a = static_cast<double>(i + 1);
    motions[i].a_before[0].x() = motions[i].a_before[1].x() = 20.0;
  }
  motions.push_back(passing_spheres(1.0));
  const auto results = motion_results(motions,
                                      {{[] { return std::make_unique<FailingMotions>(); }, 1e-6},
                                       {[] { return make_motion_kernel("own"); }, 1e-6}},
                                      3);
  ASSERT_EQ(results.size(), 2U);
  const MotionKernelResult& failing = results[0];
  EXPECT_EQ(failing.contacts, 7U);
  EXPECT_EQ(failing.answerable, 8U);
  EXPECT_EQ(failing.score.ended, 2U);
  EXPECT_EQ(failing.score.no_answer, 2U);
  EXPECT_EQ(failing.score.answered, 4U);
  EXPECT_EQ(failing.score.misses, 3U);
  EXPECT_EQ(failing.rejected, 1U);
  EXPECT_EQ(failing.hits, 3U);
  const MotionKernelResult& own = results[1];
  EXPECT_EQ(own.answerable, 9U);
  EXPECT_EQ(own.score.misses + own.score.false_alarms + own.score.late + own.score.early, 0U);
  EXPECT_GT(own.hit_ns.value(), 0.0);
  EXPECT_GT(own.rejected_ns.value(), 0.0);
}

/// Whoever turns axes, adds radii or measures time wrongly agrees with nobody. Others miss
/// contacts: sampling between its times, FCL's advancement where it arrives at a gap of a rounding
/// and takes the direction from that.
TEST(MotionKernels, MostlyAgreeOnEasyMotions) {
  std::vector<HardMotion> motions;
  for (const HardMotion& motion : hard_motions(motion_family("translating"), 1000, 1)) {
    const MotionTruth truth(motion, 1e-6);
    if (truth.contact && !truth.at_start) {
      motions.push_back(motion);
    }
  }
  const double max_early = 1e-2;  // Bullet stops a millimetre before
  for (const std::string& name : motion_kernel_names()) {
    SCOPED_TRACE(name);
    const std::unique_ptr<MotionKernel> kernel = make_motion_kernel(name);
    kernel->set_tolerance(1e-6);
    kernel->prepare(motions);
    std::vector<ContactTime> found(motions.size());
    kernel->run(0, found.size(), found.data());
    std::size_t agreed = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const ContactTime expected = contact_time(motions[i].motions(), 1e-6);
      agreed += found[i].hit && found[i].lower <= expected.upper &&
                        found[i].upper >= expected.lower - max_early
                    ? 1
                    : 0;
    }
    EXPECT_GE(agreed, name == "discrete_1" ? 1 : motions.size() / 2);
  }
}

TEST(MotionKernels, OfOthersKnowOnlyTranslations) {
  for (const std::string& name : motion_kernel_names()) {
    const std::unique_ptr<MotionKernel> kernel = make_motion_kernel(name);
    const bool knows_all = name.rfind("own", 0) == 0 || name.rfind("discrete", 0) == 0;
    const auto count = [&](const std::string& family) {
      const std::vector<HardMotion> motions = hard_motions(motion_family(family), 50, 1);
      return std::count_if(motions.begin(), motions.end(),
                           [&](const HardMotion& motion) { return kernel->can_answer(motion); });
    };
    EXPECT_EQ(count("grazing, translating"), 50) << name;
    EXPECT_EQ(count("two points"), 50) << name;
    for (const std::string family : {"random", "ends change places", "crossing"}) {
      EXPECT_EQ(count(family), knows_all ? 50 : 0) << name << ", " << family;
    }
  }
}

}  // namespace
}  // namespace fiber::test

#include "continuous/measurements.hpp"
#include "continuous/motion_times.hpp"
#include "pairs/chosen_families.hpp"
#include "statistics.hpp"

namespace fiber::bench {
namespace {

/// What is asked of all: a kernel, and a part of the extent.
struct Question {
  std::string kernel;
  double tolerance;
};

/// Each kernel with the one tolerance, and the first of those that keep any with all others, too.
std::vector<Question> questions_of(const MotionMeasurement& what) {
  std::vector<Question> questions;
  bool is_first = true;
  for (const std::string& name : what.kernels) {
    questions.push_back({name, what.tolerance});
    if (!is_first || !make_motion_kernel(name)->keeps_tolerance()) {
      continue;
    }
    is_first = false;
    for (const double tolerance : what.tolerances) {
      if (tolerance != what.tolerance) {
        questions.push_back({name, tolerance});
      }
    }
  }
  return questions;
}

double median_extent(const std::vector<HardMotion>& motions) {
  std::vector<double> extents;
  for (const HardMotion& motion : motions) {
    extents.push_back(extent_of(motion));
  }
  return median(extents);
}

MotionRow time_or_null(const std::optional<double>& time) {
  return time ? MotionRow(*time) : MotionRow();
}

MotionRow row_of(const MotionMeasurement& what, const std::string& family, const Question& question,
                 const MotionResult& result) {
  const DecisionScore& score = result.score;
  return {{"family", family},
          {"seed", what.seed},
          {"motions", what.timed},
          {"repeats", what.repeats},
          {"kernel", question.kernel},
          {"tolerance", question.tolerance},
          {"translations", result.translations},
          {"contacts", result.contacts},
          {"near", result.near},
          {"undecided", result.undecided},
          {"answerable", result.answerable},
          {"answered", score.answered},
          {"no_answer", score.no_answer},
          {"ended", score.ended},
          {"misses", score.misses},
          {"start_misses", score.start_misses},
          {"false_alarms", score.false_alarms},
          {"late", score.late},
          {"early", score.early},
          {"rejected", result.rejected},
          {"rejected_ns", time_or_null(result.rejected_ns)},
          {"hits", result.hits},
          {"hit_ns", time_or_null(result.hit_ns)}};
}

}  // namespace

void measure_motion_times(const MotionMeasurement& what, const ReportMotionRow& report) {
  const std::vector<Question> questions = questions_of(what);
  for (const MotionFamily& family : chosen_families(motion_families(), what.families)) {
    const std::vector<HardMotion> motions = hard_motions(family, what.timed, what.seed);
    const double extent = median_extent(motions);
    std::vector<MotionContestant> contestants;
    for (const Question& question : questions) {
      contestants.push_back({[question] { return make_motion_kernel(question.kernel); },
                             question.tolerance * extent});
    }
    const std::vector<MotionResult> results = motion_results(motions, contestants, what.repeats);
    for (std::size_t i = 0; i < results.size(); ++i) {
      report(row_of(what, family.name, questions[i], results[i]));
    }
  }
}

}  // namespace fiber::bench

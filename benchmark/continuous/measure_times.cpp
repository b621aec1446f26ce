#include "benchmark/continuous/measurements.hpp"
#include "benchmark/kernels/chosen_families.hpp"
#include "benchmark/kernels/motion_times.hpp"
#include "src/accuracy/statistics.hpp"
#include "validation/geometry/known_motions.hpp"

namespace fiber {
namespace {

/// A kernel, and the tolerance it is asked with, a part of the extent.
struct Question {
  std::string kernel;
  double tolerance;
};

/// Motions that all are asked about together.
struct NamedMotions {
  std::string name;
  std::vector<HardMotion> motions;
};

/// Those of the file first, if there is one.
void for_each_group(const MotionMeasurement& what,
                    const std::function<void(const NamedMotions&)>& use) {
  if (!what.known.empty()) {
    NamedMotions known{"known", {}};
    for (const KnownMotion& each : read_known_motions(what.known)) {
      known.motions.push_back(each.motion);
    }
    use(known);
  }
  for (const MotionFamily& family : chosen_families(motion_families(), what.families)) {
    use({family.name, hard_motions(family, what.timed, what.seed)});
  }
}

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

BenchmarkRow time_or_null(const std::optional<double>& time) {
  return time ? BenchmarkRow(*time) : BenchmarkRow();
}

BenchmarkRow row_of(const MotionMeasurement& what, const NamedMotions& group,
                    const Question& question, const MotionKernelResult& result) {
  const DecisionScore& score = result.score;
  return {{"family", group.name},
          {"seed", what.seed},
          {"motions", group.motions.size()},
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

void measure_motion_times(const MotionMeasurement& what, const ReportRow& report) {
  const std::vector<Question> questions = questions_of(what);
  for_each_group(what, [&](const NamedMotions& group) {
    const double extent = median_extent(group.motions);
    std::vector<MotionContestant> contestants;
    for (const Question& question : questions) {
      contestants.push_back({[question] { return make_motion_kernel(question.kernel); },
                             question.tolerance * extent});
    }
    const std::vector<MotionKernelResult> results =
        motion_results(group.motions, contestants, what.repeats);
    for (std::size_t i = 0; i < results.size(); ++i) {
      report(row_of(what, group, questions[i], results[i]));
    }
  });
}

}  // namespace fiber

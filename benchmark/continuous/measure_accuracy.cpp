#include "benchmark/continuous/measurements.hpp"
#include "benchmark/continuous/motion_accuracy.hpp"
#include "benchmark/kernels/chosen_families.hpp"
#include "validation/geometry/known_motions.hpp"

namespace fiber {
namespace {

constexpr std::uint32_t motions_per_exact_one = 100;

/// One that `fiber_query motions` reads, but for the thickness.
BenchmarkRow wrong_row(const WrongAnswer& wrong) {
  const ContactTime& answer = wrong.answer;
  return {{"motion", coordinates_of(wrong.motion)},
          {"radius_a", wrong.motion.radius_a},
          {"radius_b", wrong.motion.radius_b},
          {"tolerance", wrong.tolerance},
          {"hit", answer.hit},
          {"lower", answer.lower},
          {"upper", answer.upper},
          {"certain", answer.certain}};
}

void append(const MotionAccuracy& accuracy, BenchmarkRow& row) {
  const MotionScore& score = accuracy.score;
  row.update({{"motions", score.motions},
              {"hits", score.hits},
              {"certain", score.certain},
              {"without_upper", score.without_upper},
              {"misses", score.misses},
              {"false_alarms", score.false_alarms},
              {"wrongly_certain", score.wrongly_certain},
              {"wide", score.wide},
              {"undecided", score.undecided}});
  row["wrong"] = BenchmarkRow::array();
  for (const WrongAnswer& wrong : accuracy.wrong) {
    row["wrong"].push_back(wrong_row(wrong));
  }
}

bool has_thickness(const MotionFamily& family, std::uint64_t seed) {
  const HardMotion motion = hard_motions(family, 1, seed).front();
  return motion.radius_a + motion.radius_b > 0.0;
}

}  // namespace

void measure_motion_accuracy(const MotionMeasurement& what, const ReportRow& report) {
  for (const MotionFamily& family : chosen_families(motion_families(), what.families)) {
    const std::uint32_t one_of = has_thickness(family, what.seed) ? 1 : motions_per_exact_one;
    const MotionDraw draw{(what.count + one_of - 1) / one_of, what.seed};
    const std::vector<MotionAccuracy> found =
        motion_accuracy(family, draw, what.tolerances, what.threads, contact_time);
    for (std::size_t i = 0; i < found.size(); ++i) {
      BenchmarkRow row{
          {"family", family.name}, {"seed", what.seed}, {"tolerance", what.tolerances[i]}};
      append(found[i], row);
      report(row);
    }
  }
}

void measure_known_motions(const MotionMeasurement& what, const ReportRow& report) {
  if (what.known.empty()) {
    return;
  }
  const std::vector<KnownMotion> motions = read_known_motions(what.known);
  for (const double part : what.tolerances) {
    MotionAccuracy accuracy;
    std::uint64_t contacts = 0;
    std::uint64_t contacts_missed = 0;
    std::uint64_t contacts_invented = 0;
    std::uint64_t near_hits = 0;
    for (const auto& [set, contact, motion] : motions) {
      const double tolerance = part * extent_of(motion);
      const ContactTime answer = contact_time(motion.motions(), tolerance);
      accuracy.add({motion, tolerance, answer});
      contacts += contact ? 1 : 0;
      contacts_missed += contact && !answer.hit ? 1 : 0;
      contacts_invented += !contact && answer.hit && answer.certain ? 1 : 0;
      near_hits += !contact && answer.hit && !answer.certain ? 1 : 0;
    }
    BenchmarkRow row{{"file", what.known},
                     {"tolerance", part},
                     {"contacts", contacts},
                     {"contacts_missed", contacts_missed},
                     {"contacts_invented", contacts_invented},
                     {"near_hits", near_hits}};
    append(accuracy, row);
    report(row);
  }
}

}  // namespace fiber

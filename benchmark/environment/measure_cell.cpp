#include <algorithm>
#include <array>
#include <memory>
#include <string>

#include "benchmark/environment/cell_difference.hpp"
#include "benchmark/environment/measurements.hpp"
#include "benchmark/swaying.hpp"
#include "src/accuracy/statistics.hpp"
#include "src/tools/progress.hpp"

namespace fiber {
namespace {

/// A checker with the times it has taken and how its answers differ.
class CheckerRun {
 public:
  CheckerRun(std::string name, std::unique_ptr<CellChecker> checker)
      : name_(std::move(name)), checker_(std::move(checker)) {}

  const std::string& name() const { return name_; }

  void run_frame(const std::vector<ObjectChange>& moves, const FiberAssembly& cables) {
    const std::array<double, stage_count> times{time_of([&] { checker_->move_objects(moves); }),
                                                time_of([&] { checker_->move_cables(cables); }),
                                                time_of([&] { checker_->find_self_contacts(); }),
                                                time_of([&] { checker_->find_contacts(); }),
                                                time_of([&] { checker_->find_nearest(); })};
    double sum = 0.0;
    for (std::size_t i = 0; i < stage_count; ++i) {
      times_ms_[i].push_back(times[i]);
      sum += times[i];
    }
    sum_ms_.push_back(sum);
    answer_ = checker_->answer();
  }

  void forget_times() {
    for (std::vector<double>& times : times_ms_) {
      times.clear();
    }
    sum_ms_.clear();
  }

  const CellAnswer& answer() const { return answer_; }
  void compare(const CellAnswer& wanted) { difference_.add(wanted, answer_); }

  double median_ms() const { return median(sum_ms_); }

  BenchmarkRow row() const {
    constexpr std::array<const char*, stage_count> names{"objects_ms", "cables_ms", "self_ms",
                                                         "contacts_ms", "nearest_ms"};
    BenchmarkRow row{{"checker", name_}};
    for (std::size_t i = 0; i < stage_count; ++i) {
      row[names[i]] = median(times_ms_[i]);
    }
    row["sum_ms"] = median_ms();
    row["self_contacts"] = answer_.self_contacts.size();
    row["contacts"] = answer_.contacts.size();
    row["nearest"] = answer_.nearest;
    row["missed"] = difference_.missed();
    row["unwanted"] = difference_.unwanted();
    row["distance_error"] = difference_.distance_error();
    row["nearest_error"] = difference_.nearest_error();
    row["exceptions"] = checker_->exception_count();
    return row;
  }

 private:
  static constexpr std::size_t stage_count = 5;

  std::string name_;
  std::unique_ptr<CellChecker> checker_;
  std::array<std::vector<double>, stage_count> times_ms_;
  std::vector<double> sum_ms_;
  CellAnswer answer_;
  CellDifference difference_;
};

/// [m] Of the point that has moved farthest.
double largest_motion(const FiberAssembly& before, const FiberAssembly& after) {
  double largest = 0.0;
  for (std::size_t i = 0; i < after.point_count(); ++i) {
    largest = std::max(largest, (after.points()[i] - before.points()[i]).norm());
  }
  return largest;
}

}  // namespace

void measure_cell(const EnvironmentMeasurement& what, const ReportRow& report) {
  const Cell cell(what.size);
  FiberAssembly cables = cell.cables(0);
  std::vector<CheckerRun> runs;
  runs.emplace_back("own", make_own_checker(cell.objects(), cables, what.questions));
  if (what.beside_fcl) {
    runs.emplace_back("fcl", make_fcl_checker(cell.objects(), cables, what.questions));
  }
  std::vector<double> motions;
  Progress progress;
  for (std::uint32_t frame = 0; frame <= what.repeats; ++frame) {
    progress.show("frame " + std::to_string(frame) + " of " + std::to_string(what.repeats));
    const FiberAssembly before = cables;
    cables.update_points(cell.points(frame));
    motions.push_back(largest_motion(before, cables) / mean_segment_length(cables));
    const std::vector<ObjectChange> moves = cell.moves(frame);
    for (std::size_t turn = 0; turn < runs.size(); ++turn) {
      runs[(frame + turn) % runs.size()].run_frame(moves, cables);
    }
    for (CheckerRun& run : runs) {
      run.compare(runs.front().answer());
      if (frame == 0) {
        run.forget_times();  // memory is there, and so are trees
      }
    }
  }
  for (const CheckerRun& run : runs) {
    BenchmarkRow row = run.row();
    row["times_own"] = run.median_ms() / runs.front().median_ms();
    row["motion"] = median(motions);
    row["segments"] = cables.segment_count();
    row["objects"] = cell.objects().size();
    row["triangles"] = what.size.triangles;
    row["margin"] = what.questions.margin;
    row["threads"] = what.questions.threads;
    row["repeats"] = what.repeats;
    report(row);
  }
}

}  // namespace fiber

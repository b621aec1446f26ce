#pragma once

#include <cstddef>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "src/accuracy/answer_errors.hpp"
#include "src/accuracy/setting_outcome.hpp"

namespace fiber {

/// One setting and what it has cost and brought so far.
class SettingRun {
 public:
  explicit SettingRun(AnswerSetting setting) : setting_(std::move(setting)) {}

  const AnswerSetting& setting() const { return setting_; }

  /// The options of the next query.
  /// @param whole_ms what the reference's query takes
  QueryOptions options(double whole_ms);

  void add_time(double update_ms, double query_ms);

  /// Whether answers to the same frame may differ.
  bool depends_on_time() const { return setting_.deadline_part > 0.0; }

  /// Holds an answer against the exact one.
  /// @param fibers all points of the frame
  void judge(const FiberAssembly& fibers, const QueryResult& answer, const QueryResult& exact);

  bool has_times() const { return !times_ms_.empty(); }

  /// [ms] The median of its queries, 0 before the first.
  double query_ms() const;

  /// @param reference run whose times are of the same frames, of the same number
  /// @return of a run that has times
  SettingOutcome outcome(const SettingRun& reference) const;

 private:
  AnswerSetting setting_;
  std::vector<double> times_ms_;
  std::vector<double> queries_ms_;
  std::vector<double> deadlines_ms_;
  AnswerErrors errors_;
  std::size_t judged_ = 0;
  std::size_t complete_ = 0;
  std::size_t kept_bounds_ = 0;
  std::size_t reported_ = 0;
  double doubt_ = 0.0;  // [m]
};

}  // namespace fiber

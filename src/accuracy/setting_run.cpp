#include "src/accuracy/setting_run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/accuracy/statistics.hpp"

namespace fiber {
namespace {

/// Distances of an answer that are computed by integers; the others are those of the exact answer.
constexpr std::size_t max_integers = 20;

/// [m] What an answer states about its own error.
double doubt_of(const QueryOptions& options, const QueryResult& answer,
                const AnswerErrors& errors) {
  if (options.type == QueryType::CLOSEST) {
    return answer.contacts.empty() ? options.margin - answer.minimum_lower() : errors.bound;
  }
  const double unknown =
      answer.complete ? 0.0 : std::max(0.0, options.margin - answer.others_lower);
  return std::max(errors.bound, unknown);
}

/// The standard error of the median of ratios, by their quartiles, as if they were normal.
double error_of_ratio(const std::vector<double>& times, const std::vector<double>& others) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < std::min(times.size(), others.size()); ++i) {
    ratios.push_back(times[i] / others[i]);
  }
  const double spread = quantile(ratios, 0.75) - quantile(ratios, 0.25);
  constexpr double of_normal = 0.93;  // sqrt(pi / 2) over 1.349, the distance of the quartiles
  return of_normal * spread / (median(ratios) * std::sqrt(static_cast<double>(ratios.size())));
}

double percent(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

QueryOptions SettingRun::options(double whole_ms) {
  QueryOptions options = setting_.options;
  if (setting_.deadline_part > 0.0) {
    deadlines_ms_.push_back(setting_.deadline_part * whole_ms);
    options.deadline = 1e-3 * deadlines_ms_.back();
  }
  return options;
}

void SettingRun::add_time(double update_ms, double query_ms) {
  times_ms_.push_back(update_ms + query_ms);
  queries_ms_.push_back(query_ms);
}

double SettingRun::query_ms() const { return queries_ms_.empty() ? 0.0 : median(queries_ms_); }

void SettingRun::judge(const FiberAssembly& fibers, const QueryResult& answer,
                       const QueryResult& exact) {
  const QueryOptions& options = setting_.options;
  ++judged_;
  reported_ += answer.contacts.size();
  complete_ += answer.complete ? 1 : 0;
  if (setting_.chord_error > 0.0) {
    errors_.add(resampled_errors(options, answer, exact));
    doubt_ = 2.0 * setting_.chord_error;
    return;
  }
  const AnswerErrors errors = answer_errors(fibers, options, answer, exact, max_integers);
  errors_.add(errors);
  kept_bounds_ += errors.wrong_bounds == 0 ? 1 : 0;
  if (!exact.contacts.empty()) {
    doubt_ = std::max(doubt_, doubt_of(options, answer, errors));
  }
}

SettingOutcome SettingRun::outcome(const SettingRun& reference) const {
  SettingOutcome outcome;
  outcome.setting = setting_;
  outcome.answers = times_ms_.size();
  outcome.p50_ms = median(times_ms_);
  outcome.p99_ms = quantile(times_ms_, 0.99);
  outcome.deadline_ms = deadlines_ms_.empty() ? 0.0 : median(deadlines_ms_);
  outcome.ratio_error = error_of_ratio(times_ms_, reference.times_ms_);
  outcome.error = errors_.largest();
  outcome.doubt = doubt_;
  outcome.missed_percent = percent(errors_.missed + errors_.cut_off, errors_.expected);
  outcome.invented_percent = percent(errors_.extra, reported_);
  outcome.complete_percent = percent(complete_, judged_);
  if (setting_.chord_error == 0.0) {
    outcome.bounds_kept_percent = percent(kept_bounds_, judged_);
  }
  return outcome;
}

}  // namespace fiber

#include "src/accuracy/recommendation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "src/accuracy/number_text.hpp"

namespace fiber {
namespace {

/// [m] Below this nobody minds an error, and rounding differs from machine to machine.
constexpr double no_error = 1e-9;

/// Another setting is clearly faster below this part of the time.
constexpr double clearly_faster = 0.95;

/// A more accurate setting is taken if it takes at most so many times as long as the fastest.
constexpr double nearly_as_fast = 1.03;

/// How many times as long a median may take by chance alone: a standard error of its ratio to the
/// reference's; of few answers it is not known either.
double chance(const SettingOutcome& outcome) {
  const auto answers = static_cast<double>(std::max<std::size_t>(outcome.answers, 1));
  return 1.0 + std::max(outcome.ratio_error, 0.5 / answers);
}

/// A tolerance that is as large as the noise states a rounding more.
constexpr double slightly_more = 1.001;

/// [m] By how much an answer may be off.
double inaccuracy(const SettingOutcome& outcome) {
  return std::max({outcome.error, outcome.doubt, no_error});
}

const SettingOutcome& reference_of(const std::vector<SettingOutcome>& outcomes) {
  const auto reference =
      std::find_if(outcomes.begin(), outcomes.end(),
                   [](const SettingOutcome& outcome) { return outcome.setting.is_reference; });
  assert(reference != outcomes.end());
  return *reference;
}

bool keeps_bounds(const SettingOutcome& outcome) {
  return outcome.bounds_kept_percent.value_or(100.0) == 100.0;
}

bool is_accurate_enough(const SettingOutcome& outcome, double limit) {
  return outcome.setting.kind != SettingKind::DEADLINE && outcome.complete_percent == 100.0 &&
         outcome.missed_percent == 0.0 && outcome.invented_percent == 0.0 &&
         keeps_bounds(outcome) && inaccuracy(outcome) <= limit;
}

/// The reference, if it is accurate enough and nearly as fast as the fastest that is; else the most
/// accurate of those that are nearly as fast, and clearly faster than the reference.
const SettingOutcome& preferred(const std::vector<SettingOutcome>& outcomes,
                                const SettingOutcome& reference, double limit) {
  const SettingOutcome* fastest = &reference;
  for (const SettingOutcome& outcome : outcomes) {
    if (is_accurate_enough(outcome, limit) && outcome.p50_ms < fastest->p50_ms) {
      fastest = &outcome;
    }
  }
  const double max_ratio = nearly_as_fast * chance(*fastest);
  const double max_ms = max_ratio * fastest->p50_ms;
  if (reference.p50_ms <= max_ms) {
    return reference;
  }
  const SettingOutcome* taken = fastest;
  for (const SettingOutcome& outcome : outcomes) {
    if (is_accurate_enough(outcome, limit) && inaccuracy(outcome) < inaccuracy(*taken) &&
        outcome.p50_ms <= max_ms && max_ratio * outcome.p50_ms < reference.p50_ms) {
      taken = &outcome;
    }
  }
  return *taken;
}

std::string percent(double part) { return rounded_text(std::abs(part)) + " %"; }

/// As "costs 12 %", beside the setting that is recommended.
std::string beside(const SettingOutcome& outcome, const SettingOutcome& taken) {
  const double more = 100.0 * (outcome.p50_ms / taken.p50_ms - 1.0);
  const double rounded = std::round(more);
  return rounded == 0.0 ? "costs the same" : (more > 0.0 ? "costs " : "saves ") + percent(rounded);
}

std::string with_article(const AnswerSetting& setting) {
  switch (setting.kind) {
    case SettingKind::TOLERANCE:
    case SettingKind::DEADLINE:
    case SettingKind::SKIN:
      return setting.engine_options.skin == 0.0 ? setting.name : "a " + setting.name;
    case SettingKind::ENGINE:
      return "the " + setting.name;
    case SettingKind::RESAMPLING:
      return "fibres " + setting.name;
    default:
      return setting.name;
  }
}

/// The fastest one of a kind whose error is at most this, but for the one that is taken; nullptr if
/// there is none.
const SettingOutcome* fastest_of(SettingKind kind, double max_error,
                                 const std::vector<SettingOutcome>& outcomes,
                                 const SettingOutcome& taken) {
  const SettingOutcome* fastest = nullptr;
  for (const SettingOutcome& outcome : outcomes) {
    if (outcome.setting.kind == kind && &outcome != &taken && inaccuracy(outcome) <= max_error &&
        (fastest == nullptr || outcome.p50_ms < fastest->p50_ms)) {
      fastest = &outcome;
    }
  }
  return fastest;
}

std::string time_clause(const SettingOutcome& taken, const SettingOutcome& reference,
                        std::optional<double> frame_time) {
  std::string text = rounded_text(taken.p50_ms) + " ms";
  if (&taken != &reference) {
    text += ", " + percent(std::round(100.0 * (1.0 - taken.p50_ms / reference.p50_ms))) +
            " less than " + reference.setting.name;
  }
  if (frame_time && taken.p99_ms > 1e3 * *frame_time) {
    text += ", which is more than the " + rounded_text(1e3 * *frame_time, 3) +
            " ms of a frame in " + "one answer of a hundred";
  }
  return text;
}

/// Tells how the others would save or cost time: of tolerances one that the noise hides, if there
/// is one.
std::string others_clause(const std::vector<SettingOutcome>& outcomes, const SettingOutcome& taken,
                          std::optional<double> noise) {
  constexpr double any = std::numeric_limits<double>::infinity();
  std::string text;
  const auto add = [&](const std::string& clause) { text += (text.empty() ? "" : ", ") + clause; };
  const SettingOutcome* tolerance =
      fastest_of(SettingKind::TOLERANCE, slightly_more * noise.value_or(any), outcomes, taken);
  if (tolerance == nullptr) {
    tolerance = fastest_of(SettingKind::TOLERANCE, any, outcomes, taken);
  }
  for (const SettingOutcome* other :
       {tolerance, fastest_of(SettingKind::KERNEL, any, outcomes, taken)}) {
    if (other != nullptr) {
      add(with_article(other->setting) + ' ' + beside(*other, taken));
    }
  }
  const auto deadline = std::find_if(outcomes.begin(), outcomes.end(), [](const auto& outcome) {
    return outcome.setting.kind == SettingKind::DEADLINE;
  });
  if (deadline != outcomes.end()) {
    add(with_article(deadline->setting) + " leaves " + percent(100.0 - deadline->complete_percent) +
        " of the answers incomplete");
  }
  return text;
}

/// Settings of a kind, one that errs more after the other.
const char* plural_of(SettingKind kind) {
  switch (kind) {
    case SettingKind::KERNEL:
      return "kernels";
    case SettingKind::TOLERANCE:
      return "tolerances";
    case SettingKind::DEADLINE:
      return "deadlines";
    case SettingKind::ENGINE:
      return "engines";
    case SettingKind::SKIN:
      return "skins";
    case SettingKind::THREADS:
      return "threads";
    case SettingKind::RESAMPLING:
      break;
  }
  return "resampling";
}

/// As "those of tolerances from 1 mm, resampling and deadlines": whose errors are larger than this.
std::string larger_than(double noise, const std::vector<SettingOutcome>& outcomes) {
  std::vector<std::string> names;
  for (const SettingKind kind :
       {SettingKind::KERNEL, SettingKind::TOLERANCE, SettingKind::ENGINE, SettingKind::SKIN,
        SettingKind::THREADS, SettingKind::RESAMPLING, SettingKind::DEADLINE}) {
    double smallest = std::numeric_limits<double>::infinity();
    bool has_larger = false;
    bool has_smaller = false;
    for (const SettingOutcome& outcome : outcomes) {
      if (outcome.setting.kind == kind) {
        const bool is_larger = inaccuracy(outcome) > slightly_more * noise;
        (is_larger ? has_larger : has_smaller) = true;
        const double length =
            std::max(outcome.setting.options.tolerance, outcome.setting.chord_error);
        smallest = is_larger ? std::min(smallest, length) : smallest;
      }
    }
    if (has_larger) {
      names.push_back(plural_of(kind) +
                      (has_smaller && smallest > 0.0 ? " from " + millimetres(smallest) : ""));
    }
  }
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
  }
  return text.empty() ? "" : "those of " + text;
}

std::string noise_clause(const std::vector<SettingOutcome>& outcomes, std::optional<double> noise) {
  if (!noise) {
    return "the tracker's noise is not known, so errors above a nanometre were not accepted";
  }
  if (*noise <= no_error) {
    return "the points have no noise that errors could hide in";
  }
  const std::string larger = larger_than(*noise, outcomes);
  return "your tracker's noise of " + millimetres(*noise) + " is larger than all errors" +
         (larger.empty() ? "" : " but " + larger);
}

}  // namespace

bool is_dominated(const SettingOutcome& outcome, const SettingOutcome& other) {
  const bool is_as_accurate =
      std::max(other.error, no_error) <= std::max(outcome.error, no_error) &&
      inaccuracy(other) <= inaccuracy(outcome) && other.missed_percent <= outcome.missed_percent &&
      other.invented_percent <= outcome.invented_percent &&
      other.complete_percent >= outcome.complete_percent && keeps_bounds(other);
  return is_as_accurate && other.setting.kind != SettingKind::DEADLINE &&
         other.p50_ms * std::max(chance(other), chance(outcome)) < clearly_faster * outcome.p50_ms;
}

std::vector<bool> dominated(const std::vector<SettingOutcome>& outcomes) {
  std::vector<bool> flags;
  for (const SettingOutcome& outcome : outcomes) {
    flags.push_back(std::any_of(outcomes.begin(), outcomes.end(), [&](const SettingOutcome& other) {
      return is_dominated(outcome, other);
    }));
  }
  return flags;
}

Recommendation recommend(const std::vector<SettingOutcome>& outcomes, std::optional<double> noise,
                         std::optional<double> frame_time) {
  const SettingOutcome& reference = reference_of(outcomes);
  const double limit = std::max(inaccuracy(reference), 0.5 * noise.value_or(0.0));
  const SettingOutcome& taken = preferred(outcomes, reference, limit);
  std::string sentence =
      "take " + with_article(taken.setting) + ": " + time_clause(taken, reference, frame_time);
  const std::string others = others_clause(outcomes, taken, noise);
  sentence += (others.empty() ? "" : "; " + others) + "; " + noise_clause(outcomes, noise);
  return {static_cast<std::size_t>(&taken - outcomes.data()), sentence};
}

}  // namespace fiber

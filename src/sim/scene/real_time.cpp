#include "src/sim/scene/real_time.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>
#include <optional>
#include <stdexcept>

namespace fiber {
namespace {

/// [s] of one core, for the measurements that lead to a resolution.
constexpr double trial_budget = 2.0;

/// [s] of the scene: until then most of what falls has fallen.
constexpr double trial_time = 3.0;

/// [s] of one core, for measuring a resolution beyond these: a little more than the trial takes
/// with the one that is looked for.
constexpr double confirming_budget = 1.25 * aimed_share * trial_time;

/// The accuracies to choose from fall from the coarsest by this factor, to the finest.
constexpr double accuracy_ratio = 0.9;
constexpr double finest_accuracy = 1e-4;

struct Measurement {
  Resolution resolution;
  double work = 0.0;
  double share = 0.0;
  std::vector<double> frame_times{};  // [s]
  bool is_extrapolated = false;       // from some of the frames
};

double sum(const std::vector<double>& times, std::size_t count) {
  return std::accumulate(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(count), 0.0);
}

/// The finest resolution of at most this work, or the coarsest one. Where one substep more would be
/// too much, segments alone are finer.
Resolution finest_within(const RealTimeScene& scene, double work) {
  Resolution finest = coarsest_resolution;
  const auto refine = [&](bool is_segments_alone) {
    for (Resolution next = finest; next.segments > finest_accuracy; finest = next) {
      next.segments *= accuracy_ratio;
      next.substeps *= is_segments_alone ? 1.0 : accuracy_ratio;
      if (scene.work(next) > work) {
        return;
      }
    }
  };
  refine(false);
  refine(true);
  return finest;
}

/// Measures a resolution. The share of frames that were not reached is that of an earlier
/// measurement, in proportion.
Measurement measure(const RealTimeScene& scene, const Resolution& resolution, double budget,
                    const std::optional<Measurement>& earlier) {
  Measurement measured{resolution, scene.work(resolution), 0.0,
                       scene.frame_times(resolution, budget)};
  const std::size_t frames = measured.frame_times.size();
  const double taken = sum(measured.frame_times, frames);
  measured.is_extrapolated = taken >= budget || (earlier && earlier->frame_times.size() > frames);
  if (earlier && earlier->frame_times.size() > frames) {
    measured.share = earlier->share * taken / sum(earlier->frame_times, frames);
    // The next measurement compares with this one: what it has not seen is in proportion.
    for (std::size_t i = frames; i < earlier->frame_times.size(); ++i) {
      measured.frame_times.push_back(earlier->frame_times[i] * measured.share / earlier->share);
    }
  } else {
    measured.share = taken / (static_cast<double>(frames) * scene.time_step);
  }
  return measured;
}

/// Measures the coarsest resolution with which the scene can be made. Coarse polygons may lie in
/// each other where the curves do not.
Measurement measure_first(const RealTimeScene& scene) {
  for (Resolution resolution = coarsest_resolution;;) {
    try {
      return measure(scene, resolution, trial_budget, std::nullopt);
    } catch (const std::invalid_argument&) {
      constexpr double finest_tried = 1e-3;
      if (resolution.segments <= finest_tried) {
        throw;
      }
      resolution.segments *= 0.5;
      resolution.substeps *= 0.5;
    }
  }
}

/// Measures the finest resolution of about this work with which the scene can be made; where all of
/// these are refused, the next one beyond.
/// @returns none if there is none that is nearer to it than the earlier one
std::optional<Measurement> measure_near(const RealTimeScene& scene, double work, double budget,
                                        const Measurement& earlier) {
  std::vector<double> detours{1.0, 0.9, 1.1, 0.8, 1.2, 0.7, 1.5, 0.5, 2.0, 0.3};
  constexpr double growth = 1.5;
  constexpr double doubt = 4.0;  // of what is extrapolated from an earlier measurement
  constexpr double max_detour = 1000.0;
  const double expected = earlier.work * aimed_share / earlier.share;
  for (double detour = 3.0; detour <= std::min(max_detour, doubt * expected / work);
       detour *= growth) {
    detours.push_back(detour);
  }
  for (const double detour : detours) {
    constexpr double rounding = 1e-9;
    const Resolution resolution = finest_within(scene, work * detour * (1.0 + rounding));
    const double found = scene.work(resolution);
    const bool is_nearer = work > earlier.work ? found > earlier.work : found < earlier.work;
    if (!is_nearer) {
      continue;
    }
    try {
      return measure(scene, resolution, budget, earlier);
    } catch (const std::invalid_argument&) {
      continue;  // polygons may lie in each other where finer and coarser ones do not
    }
  }
  return std::nullopt;
}

double thread_time() {
  std::timespec time = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace

RealTimeChoice choose_for_real_time(const RealTimeScene& scene) {
  constexpr double near = 0.1;         // of the aim, relative, as long as the budget lasts
  constexpr double near_enough = 0.2;  // beyond it
  constexpr double max_growth = 6.0;   // of the share, from a measurement to the next
  constexpr double min_budget = 0.25;  // [s] that a measurement is worth
  constexpr int max_measurements = 10;
  constexpr int max_confirmed = 3;  // beyond the budget
  double used = 0.0;
  const RealTimeScene counted{scene.work,
                              [&](const Resolution& resolution, double budget) {
                                auto times = scene.frame_times(resolution, budget);
                                used += sum(times, times.size());
                                return times;
                              },
                              scene.time_step};
  Measurement best = measure_first(counted);
  std::optional<Measurement> in_time;  // the one of the largest share
  double power = 1.0;                  // of the work that the share grows with
  int confirmed = 0;
  for (int i = 1;; ++i) {
    if (best.share <= (1.0 + near_enough) * aimed_share &&
        (!in_time || best.share > in_time->share)) {
      in_time = best;
    }
    const double off = std::abs(best.share / aimed_share - 1.0);
    const bool is_searching = used <= trial_budget - min_budget && i < max_measurements;
    if (off <= (is_searching ? near : near_enough) ||
        (!is_searching && ++confirmed > max_confirmed)) {
      break;
    }
    const double growth =
        is_searching ? std::min(aimed_share / best.share, max_growth) : aimed_share / best.share;
    const auto next = measure_near(counted, best.work * std::pow(growth, 1.0 / power),
                                   is_searching ? trial_budget - used : confirming_budget, best);
    if (!next) {
      break;  // there is nothing nearer to the aim
    }
    power =
        std::clamp(std::log(next->share / best.share) / std::log(next->work / best.work), 0.5, 2.0);
    best = *next;
  }
  const Measurement& chosen = in_time ? *in_time : best;
  return {chosen.resolution, chosen.share, chosen.is_extrapolated};
}

std::vector<double> measure_frames(const SimDescription& description, double budget) {
  SimScene scene = make_sim_scene(description, 1);
  const double max_frames = std::max(1.0, std::ceil(trial_time / scene.time_step));
  std::vector<double> times;
  const double begin = thread_time();
  double before = begin;
  while (static_cast<double>(times.size()) < max_frames && before - begin < budget) {
    bool has_failed = false;
    try {
      scene.advance();
    } catch (const std::runtime_error&) {
      has_failed = true;  // the frames so far are what there is to measure
    }
    const double now = thread_time();
    times.push_back(now - before);
    before = now;
    if (has_failed) {
      break;
    }
  }
  return times;
}

}  // namespace fiber
